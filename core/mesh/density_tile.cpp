#include "core/mesh/density_tile.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/check.hpp"
#include "core/mesh/height_tile.hpp"
#include "core/mesh/vertex_maker.hpp"

namespace talus {
namespace {

bool touches_air(const Samples& samples, int x, int y, int z) {
  const float* p = samples.row(y, z) + x;
  return p[1] >= 0.0F || p[-1] >= 0.0F || samples.at(x, y + 1, z) >= 0.0F || samples.at(x, y - 1, z) >= 0.0F ||
         samples.at(x, y, z + 1) >= 0.0F || samples.at(x, y, z - 1) >= 0.0F;
}

/// y component of the unit gradient.
float up_at(const Samples& samples, int x, int y, int z) {
  const glm::vec3 g = samples.gradient(x, y, z);
  const float length2 = g.x * g.x + g.y * g.y + g.z * g.z;
  return length2 > 0.0F ? g.y / std::sqrt(length2) : 1.0F;
}

std::int16_t quantised(float density, float inverse_step) {
  constexpr auto kHeld = static_cast<float>(kDensityHeld);
  return static_cast<std::int16_t>(std::clamp(std::floor(density * inverse_step), -kHeld, kHeld - 1.0F));
}

}  // namespace

ChunkKind sample_density_tile(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch,
                              DensityTile& out) {
  const ColumnBlock& columns = scratch.columns;
  const int count = world.cells() + 1;
  TALUS_CHECK(columns.grid == chunk_columns(world, key));
  if (!columns.has_volume) world.volume(scratch.columns, scratch.volume);
  const std::int64_t step_voxel = columns.grid.step_voxel;
  const std::int64_t first_voxel = corner_voxel(key, world.cells()).y - step_voxel;
  const int layers = count + 2;
  scratch.density.resize(std::max(scratch.density.size(), density_floats(columns.grid, layers)));
  const DensityBox box = sample_density(world, columns, first_voxel, layers, {}, scratch.volume, scratch.density);
  const Samples field(box, scratch.density.data(), -1);

  const double cell_m = static_cast<double>(step_voxel) * world.voxel_m();
  out.cells = world.cells();
  out.step_m = cell_m / kDensityStepsPerCell;
  const auto samples = static_cast<std::size_t>(count) * static_cast<std::size_t>(count * count);
  out.densities.resize(samples);
  out.materials.resize(samples);
  const auto inverse_step = static_cast<float>(1.0 / out.step_m);
  std::size_t rocks = 0;
  std::size_t to = 0;
  for (int y = 0; y < count; ++y) {
    const auto y_m = static_cast<float>(static_cast<double>(first_voxel + (y + 1) * step_voxel) * world.voxel_m());
    for (int z = 0; z < count; ++z) {
      for (int x = 0; x < count; ++x, ++to) {
        const float density = field.at(x, y, z);
        out.densities[to] = quantised(density, inverse_step);
        if (density >= 0.0F) {
          out.materials[to] = kNoMaterial;
          continue;
        }
        ++rocks;
        const std::size_t column = static_cast<std::size_t>(z + 1) * columns.stride + static_cast<std::size_t>(x + 1);
        const glm::i64vec2 voxel{columns.grid.x_voxel + (x + 1) * step_voxel,
                                 columns.grid.z_voxel + (z + 1) * step_voxel};
        const Material material =
            touches_air(field, x, y, z)
                ? surface_material(world, columns, x, z, up_at(field, x, y, z), y_m)
                : world.rock({columns.stack_m[column], columns.choice[column], y_m, voxel, step_voxel});
        out.materials[to] = static_cast<std::uint8_t>(material);
      }
    }
  }
  if (rocks == 0) return ChunkKind::kAir;
  return rocks == samples ? ChunkKind::kRock : ChunkKind::kMesh;
}

}  // namespace talus
