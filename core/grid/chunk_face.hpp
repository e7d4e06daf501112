// The six faces of a chunk, and what lies across them. Pure.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/grid/chunk_key.hpp"

namespace talus {

/// In the order of bits and numbers on the wire; named by the direction one leaves the chunk in.
enum class ChunkFace : std::uint8_t { kPx, kNx, kPy, kNy, kPz, kNz };
inline constexpr std::size_t kChunkFaces = 6;
inline constexpr std::array<ChunkFace, kChunkFaces> kAllChunkFaces{ChunkFace::kPx, ChunkFace::kNx, ChunkFace::kPy,
                                                                   ChunkFace::kNy, ChunkFace::kPz, ChunkFace::kNz};
inline constexpr std::array<std::string_view, kChunkFaces> kChunkFaceNames{"px", "nx", "py", "ny", "pz", "nz"};

/// The axis a face is perpendicular to: 0 x, 1 y, 2 z.
constexpr int axis_of(ChunkFace face) {
  return static_cast<int>(face) / 2;
}
/// Whether the face lies at the upper end of its axis.
constexpr bool is_high(ChunkFace face) {
  return static_cast<int>(face) % 2 == 0;
}
constexpr ChunkFace opposite(ChunkFace face) {
  return static_cast<ChunkFace>(static_cast<int>(face) ^ 1);
}
constexpr unsigned bit_of(ChunkFace face) {
  return 1U << static_cast<unsigned>(face);
}

/// The chunk of the same LOD across `face`; outside the world (not is_valid) at its border.
constexpr ChunkKey neighbour_of(const ChunkKey& key, ChunkFace face) {
  const std::int32_t step = is_high(face) ? 1 : -1;
  ChunkKey out = key;
  (axis_of(face) == 0 ? out.x : axis_of(face) == 1 ? out.y : out.z) += step;
  return out;
}

/// The four chunks one LOD finer that touch `face` of `key` from the outside. Requires key.lod > 0.
constexpr std::array<ChunkKey, 4> finer_across(const ChunkKey& key, ChunkFace face) {
  std::array<ChunkKey, 4> out{};
  const auto children = children_of(neighbour_of(key, face));
  std::size_t count = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    const bool is_upper = ((i >> axis_of(face)) & 1U) != 0;
    if (is_upper != is_high(face)) out[count++] = children[i];
  }
  return out;
}

/// One face of one chunk: what a seam strip belongs to. Valid when the key is.
struct StripKey {
  ChunkKey key;
  ChunkFace face = ChunkFace::kPx;

  friend constexpr auto operator<=>(const StripKey&, const StripKey&) = default;
};

/// The face of that name: px nx py ny pz nz.
constexpr std::optional<ChunkFace> face_named(std::string_view name) {
  for (const ChunkFace face : kAllChunkFaces) {
    if (kChunkFaceNames[static_cast<std::size_t>(face)] == name) return face;
  }
  return std::nullopt;
}

}  // namespace talus
