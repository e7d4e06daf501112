#include "core/world/density.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/check.hpp"
#include "core/volume/field.hpp"
#include "core/world/terms.hpp"

namespace talus {
namespace {

/// Rows lie closer than whole vectors: each row's last vector runs into the next row, which is written after it.
std::size_t packed_stride(const ColumnGrid& grid) {
  return (static_cast<std::size_t>(grid.width) + 3) / 4 * 4;
}

}  // namespace

void row_spans(const WorldFunction& world, const ColumnBlock& columns, std::vector<HeightSpan>& out) {
  const ColumnGrid& grid = columns.grid;
  TALUS_CHECK(columns.has_volume);
  out.resize(static_cast<std::size_t>(grid.depth));
  const auto width = static_cast<std::size_t>(grid.width);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const float* height = &columns.height_m[k * columns.stride];
    const auto [low, high] = std::minmax_element(height, height + width);
    out[k] = {*low, *high};
    if (!columns.has_jut) continue;
    const float* jut = &columns.jut_m[k * columns.stride];
    for (std::size_t i = 0; i < width; ++i) out[k].high_m = std::max(out[k].high_m, height[i] + jut[i]);
  }
  const float swell_m = carve_swell_m(world.terms().carve);
  for (const CarveSphere& s : columns.spheres) {
    const float bottom_m = s.y_m - (s.radius_m + swell_m) / s.inverse_stretch;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double z_m =
          static_cast<double>(grid.z_voxel + static_cast<std::int64_t>(k) * grid.step_voxel) * grid.voxel_m;
      if (std::abs(z_m - s.z_m) <= static_cast<double>(s.radius_m + swell_m))
        out[k].low_m = std::min(out[k].low_m, bottom_m);
    }
  }
}

std::size_t density_floats(const ColumnGrid& grid, int layers) {
  return packed_stride(grid) * static_cast<std::size_t>(grid.depth) * static_cast<std::size_t>(layers) + kRowPadding;
}

DensityBox sample_density(const WorldFunction& world, const ColumnBlock& columns, std::int64_t y_voxel, int layers,
                          std::span<const LayerInterval> wanted, VolumeScratch& scratch, std::span<float> samples) {
  const ColumnGrid& grid = columns.grid;
  TALUS_CHECK(columns.has_volume && y_voxel % grid.step_voxel == 0);
  TALUS_CHECK(samples.size() >= density_floats(grid, layers));
  const DensityBox box{y_voxel, layers, packed_stride(grid), static_cast<std::size_t>(grid.depth)};
  TALUS_CHECK(wanted.empty() || wanted.size() == box.depth);
  const WorldFunction::Terms& t = world.terms();
  const FieldColumns field_columns{grid,
                                   columns.height_m.data(),
                                   columns.steepness.data(),
                                   columns.has_jut ? columns.jut_m.data() : nullptr,
                                   columns.stack_m.data(),
                                   columns.choice.data(),
                                   columns.spheres};
  Field field(*t.profile, t.carve, field_columns, scratch.field);
  float* out = samples.data();
  for (int j = 0; j < layers; ++j) {
    field.layer(y_voxel + j * grid.step_voxel);
    for (std::size_t k = 0; k < box.depth; ++k, out += box.stride) {
      if (!wanted.empty() && (j < wanted[k].first || j >= wanted[k].first + wanted[k].count)) continue;
      field.row(static_cast<int>(k), out);
    }
  }
  return box;
}

}  // namespace talus
