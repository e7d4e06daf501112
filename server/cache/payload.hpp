// What a door hands out for a chunk, and the name it goes by. Immutable once published; any thread.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/hash.hpp"
#include "core/grid/chunk_face.hpp"
#include "core/grid/chunk_key.hpp"
#include "core/map/map_view.hpp"
#include "core/mesh/chunk_mesh.hpp"

namespace talus::server {

/// kHeight and kTile are of a whole column of chunks; kMap is a picture of a map tile: key.lod is its zoom, key.x and
/// key.z are its x and y; kStrip and kMeshoptStrip are of one face of a chunk. The others are of one chunk.
enum class PayloadFormat : std::uint8_t {
  kDraco,
  kGlb,
  kDensity,
  kHeight,
  kMap,
  kStrip,
  kTile,
  kMeshopt,
  kMeshoptStrip
};
inline constexpr std::size_t kPayloadFormats = 9;

/// What chunks and their strips travel as: the names of hello's formats, and of URLs behind the dot.
struct MeshFormat {
  std::string_view name;
  PayloadFormat chunk;
  PayloadFormat strip;
};
/// The first is what a client gets that names none.
inline constexpr std::array<MeshFormat, 2> kMeshFormats{{
    {"drc", PayloadFormat::kDraco, PayloadFormat::kStrip},
    {"mesh", PayloadFormat::kMeshopt, PayloadFormat::kMeshoptStrip},
}};
constexpr const MeshFormat* mesh_format_named(std::string_view name) {
  for (const MeshFormat& format : kMeshFormats) {
    if (format.name == name) return &format;
  }
  return nullptr;
}

/// Whether the payload is of a whole chunk's surface alone, so that it knows which faces that reaches.
constexpr bool is_chunk_mesh(PayloadFormat format) {
  return format == PayloadFormat::kDraco || format == PayloadFormat::kMeshopt;
}
constexpr bool is_strip(PayloadFormat format) {
  return format == PayloadFormat::kStrip || format == PayloadFormat::kMeshoptStrip;
}

/// Whether a payload's name has an origin its positions are counted from.
constexpr bool has_origin(PayloadFormat format) {
  return format == PayloadFormat::kGlb || format == PayloadFormat::kTile;
}

/// Encoded bytes of one chunk, column, map tile or strip. Without bytes when the chunk is all air or all rock, or the
/// strip is empty (which is of kind air).
struct ChunkPayload {
  ChunkKind kind = ChunkKind::kAir;
  std::vector<std::byte> bytes;
  std::uint8_t faces = 0;  ///< that a chunk's surface reaches, bits of ChunkFace
};
using PayloadRef = std::shared_ptr<const ChunkPayload>;

/// Names a payload: equal names, equal bytes.
struct PayloadName {
  std::uint32_t world = 0;  ///< index of the world in this server
  PayloadFormat format = PayloadFormat::kDraco;
  ChunkKey key;                        ///< of a column: y is 0
  ChunkFace face = ChunkFace::kPx;     ///< of a strip; kPx for other formats
  MapLayer layer = MapLayer::kShaded;  ///< of a map; kShaded for other formats
  glm::dvec3 origin{};                 ///< metres; zero where has_origin is false
  friend bool operator==(const PayloadName&, const PayloadName&) = default;
};

struct PayloadNameHash {
  std::size_t operator()(const PayloadName& name) const noexcept {
    std::uint64_t h = mix64(ChunkKeyHash{}(name.key), (std::uint64_t{name.world} << 24) |
                                                          (std::uint64_t{static_cast<std::uint8_t>(name.layer)} << 16) |
                                                          (std::uint64_t{static_cast<std::uint8_t>(name.face)} << 8) |
                                                          static_cast<std::uint8_t>(name.format));
    if (has_origin(name.format)) {
      // + 0.0 makes one of the two zeros, which are equal.
      for (const double c : {name.origin.x, name.origin.y, name.origin.z})
        h = mix64(h, std::bit_cast<std::uint64_t>(c + 0.0));
    }
    return static_cast<std::size_t>(h);
  }
};

}  // namespace talus::server
