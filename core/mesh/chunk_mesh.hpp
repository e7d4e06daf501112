// The surface inside one chunk, on the lattice that all chunks of its LOD share. Pure data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace talus {

enum class ChunkKind : std::uint8_t { kAir, kRock, kMesh };

/// Lattice steps per cell edge. A power of two, so lattices of neighbouring LODs nest and positions are exact in
/// floats: a vertex lies at corner + step * (voxel_m * 2^lod / kStepsPerCell).
inline constexpr int kStepsPerCell = 64;

/// A ridge map's -1 (crease) .. +1 (ridge) as it travels: 0..255, 128 is neither.
constexpr std::uint8_t ridge_byte(float ridge) {
  const float held = ridge < -1.0F ? -1.0F : ridge > 1.0F ? 1.0F : ridge;
  return static_cast<std::uint8_t>(held * 127.0F + 128.0F);
}

/// Triangles wind counter-clockwise seen from the air. Vertices are shared inside the chunk; the surface is closed but
/// for the chunk's faces. Arrays of vertices have equal length.
struct ChunkMesh {
  std::vector<glm::u16vec3> positions;  ///< steps from the chunk's lowest corner, 0..cells * kStepsPerCell
  std::vector<glm::vec3> normals;       ///< unit, towards the air
  std::vector<std::uint8_t> materials;  ///< Material
  std::vector<std::uint8_t> ridges;     ///< ridge map, 0 (crease) .. 255 (ridge)
  std::vector<std::uint32_t> indices;   ///< three per triangle

  void clear() {
    positions.clear();
    normals.clear();
    materials.clear();
    ridges.clear();
    indices.clear();
  }
  std::size_t triangles() const { return indices.size() / 3; }
};

/// Faces of the chunk that its surface reaches, as bits of ChunkFace. Where no finer chunk across a face reaches it,
/// the coarser one does not either, and there is no strip.
unsigned faces_reached(const ChunkMesh& mesh, int cells);

/// Appends `part` to `out` with its positions moved up by `up_steps`, which must leave them within 16 bits.
void append_above(const ChunkMesh& part, int up_steps, ChunkMesh& out);

}  // namespace talus
