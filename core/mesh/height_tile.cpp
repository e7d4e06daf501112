#include "core/mesh/height_tile.hpp"

#include <cmath>

#include "core/base/check.hpp"
#include "core/mesh/chunk_mesh.hpp"

namespace talus {

float ground_up(const ColumnBlock& columns, int i, int k) {
  const float* height = &columns.height_m[static_cast<std::size_t>(k + 1) * columns.stride];
  const auto stride = static_cast<std::ptrdiff_t>(columns.stride);
  const auto span_m = static_cast<float>(2.0 * static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m);
  const float* here = height + i + 1;
  const float x = (here[1] - here[-1]) / span_m;
  const float z = (here[stride] - here[-stride]) / span_m;
  return 1.0F / std::sqrt(1.0F + x * x + z * z);
}

namespace {

/// What lies at a height of a column, out in the open or under a roof.
Material material_at(const WorldFunction& world, const ColumnBlock& columns, int i, int k, float up, float height_m,
                     bool is_roofed) {
  const std::size_t at = static_cast<std::size_t>(k + 1) * columns.stride + static_cast<std::size_t>(i + 1);
  const glm::i64vec2 voxel{columns.grid.x_voxel + (i + 1) * columns.grid.step_voxel,
                           columns.grid.z_voxel + (k + 1) * columns.grid.step_voxel};
  const Material cover = is_roofed
                             ? world.sheltered(height_m, up)
                             : world.cover({height_m, up, columns.ridge[at], columns.hilliness[at], columns.beach[at],
                                            voxel, columns.districts_at(at), columns.grid.step_voxel});
  if (cover != Material::kRock) return cover;
  return world.rock({columns.stack_m[at], columns.choice[at], height_m, voxel, columns.grid.step_voxel});
}

}  // namespace

Material surface_material(const WorldFunction& world, const ColumnBlock& columns, int i, int k, float up,
                          float height_m) {
  const std::size_t at = static_cast<std::size_t>(k + 1) * columns.stride + static_cast<std::size_t>(i + 1);
  return material_at(world, columns, i, k, up, height_m, top_m(columns, at) - height_m > kUnderRoof_m);
}

void sample_height_tile(const WorldFunction& world, const ColumnBlock& columns, HeightTile& out) {
  const int count = columns.grid.width - 2;
  TALUS_CHECK(count >= 2 && columns.grid.depth == columns.grid.width);
  out.cells = count - 1;
  out.step_m = static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m / kStepsPerCell;
  const auto samples = static_cast<std::size_t>(count * count);
  out.heights.resize(samples);
  out.ridges.resize(samples);
  out.materials.resize(samples);
  std::size_t to = 0;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < count; ++i, ++to) {
      const std::size_t at = static_cast<std::size_t>(k + 1) * columns.stride + static_cast<std::size_t>(i + 1);
      const float height_m = columns.height_m[at];
      out.heights[to] = static_cast<std::int32_t>(std::floor(static_cast<double>(height_m) / out.step_m + 0.5));
      out.ridges[to] = ridge_byte(columns.ridge[at]);
      const float up = ground_up(columns, i, k);
      out.materials[to] = static_cast<std::uint8_t>(material_at(world, columns, i, k, up, height_m, false));
    }
  }
}

}  // namespace talus
