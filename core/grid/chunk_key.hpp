// Where chunks are: keys, their boxes and their kin. Pure.
//
// Spaces. *World*: metres, double, y up. *Voxel*: whole LOD 0 samples, int64, world = voxel * voxel_m. *Chunk*: whole
// chunks of one LOD, int32. A chunk of LOD L is a cube of `cells` cells, each 2^L voxels wide, so a lattice of LOD L +
// 1 is every second sample of the lattice of LOD L. Division rounds down everywhere: voxel -1 lies in chunk -1.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

namespace talus {

/// The coarsest LOD a key may name; LOD 0 is the finest.
inline constexpr int kLodMax = 12;
/// Chunk coordinates reach +-this at every LOD: child and neighbour arithmetic then never leaves 32 bits
/// (2 * (2^30 - 1) + 1 = 2^31 - 1), and a voxel coordinate stays below 2^30 * 2^12 * 2^5 = 2^47, exact in a double.
inline constexpr std::int32_t kChunkLimit = (1 << 30) - 1;

struct ChunkKey {
  std::int32_t lod = 0;  ///< 0..kLodMax
  std::int32_t x = 0;    ///< each in -kChunkLimit..kChunkLimit
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend constexpr auto operator<=>(const ChunkKey&, const ChunkKey&) = default;
};

/// Whether every field is within its limit. Keys from outside are tested once, at the edge; all else takes valid keys.
constexpr bool is_valid(const ChunkKey& key) {
  const auto inside = [](std::int32_t c) { return c >= -kChunkLimit && c <= kChunkLimit; };
  return key.lod >= 0 && key.lod <= kLodMax && inside(key.x) && inside(key.y) && inside(key.z);
}

/// The chunk one LOD coarser that holds `key`. Requires key.lod < kLodMax.
constexpr ChunkKey parent_of(const ChunkKey& key) {
  return {key.lod + 1, key.x >> 1, key.y >> 1, key.z >> 1};
}

/// The eight chunks one LOD finer that fill `key`; x varies fastest, then y, then z. Requires key.lod > 0.
constexpr std::array<ChunkKey, 8> children_of(const ChunkKey& key) {
  std::array<ChunkKey, 8> out{};
  for (std::int32_t i = 0; i < 8; ++i) {
    out[static_cast<std::size_t>(i)] = {key.lod - 1, 2 * key.x + (i & 1), 2 * key.y + ((i >> 1) & 1),
                                        2 * key.z + (i >> 2)};
  }
  return out;
}

/// The sample at a chunk's lowest corner, in voxels.
constexpr glm::i64vec3 corner_voxel(const ChunkKey& key, int cells) {
  const auto scale = [&](std::int32_t c) {
    return static_cast<std::int64_t>(c) * cells * (std::int64_t{1} << key.lod);
  };
  return {scale(key.x), scale(key.y), scale(key.z)};
}

struct BoxWorld {
  glm::dvec3 low{};   ///< metres
  glm::dvec3 high{};  ///< metres, exclusive
};

/// The space a chunk fills. `cells` per edge, `voxel_m` metres per voxel.
constexpr BoxWorld box_of(const ChunkKey& key, int cells, double voxel_m) {
  const glm::i64vec3 corner = corner_voxel(key, cells);
  const double edge = static_cast<double>(std::int64_t{cells} << key.lod) * voxel_m;
  const glm::dvec3 low{static_cast<double>(corner.x) * voxel_m, static_cast<double>(corner.y) * voxel_m,
                       static_cast<double>(corner.z) * voxel_m};
  return {low, low + glm::dvec3{edge, edge, edge}};
}

struct ChunkKeyHash {
  std::size_t operator()(const ChunkKey& key) const noexcept;
};

}  // namespace talus
