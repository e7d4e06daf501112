#include "client_sample/cli/mesh_file.hpp"

#include <bit>
#include <cstdint>

#include <fmt/format.h>

#include "core/strata/material.hpp"

namespace talus::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as memory has it");

glm::dvec3 place(const ChunkMesh& mesh, std::size_t i, const protocol::MeshLattice& lattice, const glm::dvec3& corner) {
  return corner + glm::dvec3(mesh.positions[i]) * lattice.step_m;
}

std::uint32_t vertex_colour(const ChunkMesh& mesh, std::size_t i) {
  const std::size_t material = mesh.materials[i];
  return kMaterials[material < kMaterials.size() ? material : 0].colour_rgb;
}

template <typename T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string encode_obj(const ChunkMesh& mesh, const protocol::MeshLattice& lattice, const glm::dvec3& corner_m) {
  std::string out = "# talus\n";
  auto at = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 p = place(mesh, i, lattice, corner_m);
    const std::uint32_t rgb = vertex_colour(mesh, i);
    fmt::format_to(at, "v {} {} {} {:.4f} {:.4f} {:.4f}\n", p.x, p.y, p.z, (rgb >> 16 & 0xFF) / 255.0,
                   (rgb >> 8 & 0xFF) / 255.0, (rgb & 0xFF) / 255.0);
  }
  for (const glm::vec3& n : mesh.normals) fmt::format_to(at, "vn {:.5f} {:.5f} {:.5f}\n", n.x, n.y, n.z);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i] + 1;
    const std::uint32_t b = mesh.indices[i + 1] + 1;
    const std::uint32_t c = mesh.indices[i + 2] + 1;
    fmt::format_to(at, "f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
  }
  return out;
}

std::string encode_ply(const ChunkMesh& mesh, const protocol::MeshLattice& lattice, const glm::dvec3& corner_m) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment talus\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar material\nproperty uchar ridge\n"
      "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 p = place(mesh, i, lattice, corner_m);
    put(out, p.x), put(out, p.y), put(out, p.z);
    put(out, mesh.normals[i].x), put(out, mesh.normals[i].y), put(out, mesh.normals[i].z);
    const std::uint32_t rgb = vertex_colour(mesh, i);
    for (const int shift : {16, 8, 0}) put(out, static_cast<std::uint8_t>(rgb >> shift & 0xFF));
    put(out, mesh.materials[i]), put(out, mesh.ridges[i]);
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    put(out, std::uint8_t{3});
    for (std::size_t c = 0; c < 3; ++c) put(out, mesh.indices[i + c]);
  }
  return out;
}

}  // namespace talus::cli
