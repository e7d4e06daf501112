#include <algorithm>

#include "core/base/check.hpp"
#include "protocol/meshopt_codec.hpp"
#include "tests/fuzz/fuzz_one.hpp"

int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::protocol;
  const MeshLattice lattice = mesh_lattice({0, 0, 0, 0}, 16, 1.0);
  const auto mesh = decode_meshopt(std::as_bytes(std::span(data, size)), lattice);
  if (!mesh) return 0;
  const std::size_t vertices = mesh->positions.size();
  TALUS_CHECK(mesh->normals.size() == vertices && mesh->materials.size() == vertices &&
              mesh->ridges.size() == vertices);
  TALUS_CHECK(mesh->triangles() <= lattice.triangles_max && mesh->indices.size() % 3 == 0);
  for (const std::uint32_t index : mesh->indices) TALUS_CHECK(index < vertices);
  for (const auto& p : mesh->positions) TALUS_CHECK(std::max({p.x, p.y, p.z}) <= 16 * talus::kStepsPerCell);
  // What was let in can be sent on, and means the same then.
  const auto again = decode_meshopt(*encode_meshopt(*mesh, lattice), lattice);
  TALUS_CHECK(again.has_value() && again->triangles() == mesh->triangles());
  return 0;
}
