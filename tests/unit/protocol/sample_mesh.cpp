#include "tests/unit/protocol/sample_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace talus::protocol {

ChunkMesh sample_surface(int cells, unsigned seed) {
  ChunkMesh mesh;
  const int side = cells + 1;
  const double phase = 0.7 * seed;
  const int top = cells * kStepsPerCell;
  for (int k = 0; k < side; ++k) {
    for (int i = 0; i < side; ++i) {
      const double height = 0.5 + 0.3 * std::sin(0.31 * i + phase) * std::cos(0.23 * k - phase);
      const int y = std::clamp(static_cast<int>(height * top), 0, top);
      mesh.positions.emplace_back(i * kStepsPerCell, y, k * kStepsPerCell);
      const glm::vec3 n{static_cast<float>(-std::cos(0.31 * i + phase)), 1.5F, static_cast<float>(std::sin(0.23 * k))};
      mesh.normals.push_back(n / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z));
      mesh.materials.push_back(static_cast<std::uint8_t>((i / 5 + k / 7) % 7));
      mesh.ridges.push_back(static_cast<std::uint8_t>((i * 7 + k * 3) % 256));
    }
  }
  for (int k = 0; k < cells; ++k) {
    for (int i = 0; i < cells; ++i) {
      const auto at = static_cast<std::uint32_t>(k * side + i);
      const auto row = static_cast<std::uint32_t>(side);
      mesh.indices.insert(mesh.indices.end(), {at, at + row, at + 1, at + 1, at + row, at + row + 1});
    }
  }
  return mesh;
}

ChunkMesh sample_pinched_tetrahedra() {
  ChunkMesh mesh;
  // 0-1 is the shared edge; 0 is the shared vertex.
  mesh.positions = {{1000, 1000, 1000}, {1100, 1000, 1000}, {1000, 1100, 1000}, {1000, 1000, 1100}, {1000, 900, 1000},
                    {1000, 1000, 900},  {900, 1000, 1000},  {900, 900, 1000},   {900, 1000, 900}};
  const auto tetrahedron = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.indices.insert(mesh.indices.end(), {a, c, b, a, b, d, a, d, c, b, c, d});
  };
  tetrahedron(0, 1, 2, 3);
  tetrahedron(0, 1, 4, 5);
  tetrahedron(0, 6, 7, 8);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
    mesh.materials.push_back(static_cast<std::uint8_t>(i));
    mesh.ridges.push_back(static_cast<std::uint8_t>(20 * i));
  }
  return mesh;
}

std::vector<Face> faces_of(const ChunkMesh& mesh) {
  std::vector<Face> out;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    Face face;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.indices[i + c];
      face[c] = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z, mesh.materials[v], mesh.ridges[v]};
    }
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    out.push_back(face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace talus::protocol
