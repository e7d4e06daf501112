#include "core/mesh/chunk_mesh.hpp"

#include "core/base/check.hpp"

namespace talus {

void append_above(const ChunkMesh& part, int up_steps, ChunkMesh& out) {
  const auto first = static_cast<std::uint32_t>(out.positions.size());
  for (const glm::u16vec3& p : part.positions) {
    const int y = p.y + up_steps;
    TALUS_CHECK(y >= 0 && y <= 0xFFFF);
    out.positions.emplace_back(p.x, static_cast<std::uint16_t>(y), p.z);
  }
  out.normals.insert(out.normals.end(), part.normals.begin(), part.normals.end());
  out.materials.insert(out.materials.end(), part.materials.begin(), part.materials.end());
  out.ridges.insert(out.ridges.end(), part.ridges.begin(), part.ridges.end());
  for (const std::uint32_t index : part.indices) out.indices.push_back(first + index);
}

}  // namespace talus
