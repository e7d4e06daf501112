// The Draco payload inside a glTF asset: that of encode_draco and a colour per vertex. Pure.
#pragma once

#include <cstddef>
#include <expected>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "protocol/mesh_codec.hpp"

namespace talus::protocol {

/// Unique ids of the attributes besides POSITION (0) and NORMAL (1).
inline constexpr int kDracoMaterialId = 2;
inline constexpr int kDracoRidgeId = 3;
inline constexpr int kDracoColourId = 4;

/// Bytes, and what a decoder makes of them.
struct ColouredDraco {
  std::vector<std::byte> bytes;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  glm::u16vec3 low{};   ///< steps of the lattice
  glm::u16vec3 high{};  ///< inclusive
};

/// As encode_draco at kDracoSpeed, with COLOR (uint16 x 3) from `palette` by material; a material beyond the palette
/// has its first colour. Requires a palette.
std::expected<ColouredDraco, CodecError> encode_coloured_draco(const ChunkMesh& mesh, const MeshLattice& lattice,
                                                               std::span<const glm::u16vec3> palette);

}  // namespace talus::protocol
