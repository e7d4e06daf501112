#include "core/world/density.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/check.hpp"
#include "core/volume/field.hpp"
#include "core/world/terms.hpp"

namespace talus {
namespace {

/// Columns beside a part that its vertices' normals and its neighbours' need.
constexpr std::size_t kHalo = 2;

/// The spans of `part_columns` columns of a row each, and of those beside them.
void spans_by_part(const WorldFunction& world, const ColumnBlock& columns, std::size_t part_columns,
                   std::vector<HeightSpan>& out) {
  const ColumnGrid& grid = columns.grid;
  TALUS_CHECK(columns.has_volume);
  const auto width = static_cast<std::size_t>(grid.width);
  const std::size_t parts = (width + part_columns - 1) / part_columns;
  const float swell_m = carve_swell_m(world.terms().carve);
  const auto metres = [&](std::int64_t corner, std::size_t n) {
    return static_cast<double>(corner + static_cast<std::int64_t>(n) * grid.step_voxel) * grid.voxel_m;
  };
  out.clear();
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const float* height = &columns.height_m[k * columns.stride];
    for (std::size_t p = 0; p < parts; ++p) {
      const std::size_t first = p == 0 ? 0 : p * part_columns - kHalo;
      const std::size_t end = std::min((p + 1) * part_columns + kHalo, width);
      const auto [low, high] = std::minmax_element(height + first, height + end);
      HeightSpan span{*low, *high};
      const float* jut = columns.has_jut ? &columns.jut_m[k * columns.stride] : nullptr;
      for (std::size_t i = first; jut != nullptr && i < end; ++i)
        span.high_m = std::max(span.high_m, height[i] + jut[i]);
      for (const CarveSphere& s : columns.spheres) {
        const auto reach_m = static_cast<double>(s.radius_m + swell_m);
        if (std::abs(metres(grid.z_voxel, k) - s.z_m) > reach_m) continue;
        if (metres(grid.x_voxel, first) - s.x_m > reach_m || s.x_m - metres(grid.x_voxel, end - 1) > reach_m) continue;
        span.low_m = std::min(span.low_m, s.y_m - (s.radius_m + swell_m) / s.inverse_stretch);
      }
      out.push_back(span);
    }
  }
}

/// Rows lie closer than whole vectors: each row's last vector runs into the next row, which is written after it.
std::size_t packed_stride(const ColumnGrid& grid) {
  return (static_cast<std::size_t>(grid.width) + 3) / 4 * 4;
}

}  // namespace

void row_spans(const WorldFunction& world, const ColumnBlock& columns, std::vector<HeightSpan>& out) {
  spans_by_part(world, columns, static_cast<std::size_t>(columns.grid.width), out);
}

void part_spans(const WorldFunction& world, const ColumnBlock& columns, std::vector<HeightSpan>& out) {
  spans_by_part(world, columns, kPartSamples, out);
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
  const std::size_t parts = wanted.empty() ? 1 : wanted.size() / box.depth;
  const auto width = static_cast<std::size_t>(grid.width);
  const std::size_t part_samples = parts == 1 ? width : kPartSamples;
  TALUS_CHECK(wanted.size() % box.depth == 0 && parts * part_samples >= width);
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
      for (std::size_t p = 0; p < parts; ++p) {
        if (!wanted.empty()) {
          const LayerInterval& layers_of_part = wanted[k * parts + p];
          if (j < layers_of_part.first || j >= layers_of_part.first + layers_of_part.count) continue;
        }
        field.part(static_cast<int>(k), p * part_samples, std::min((p + 1) * part_samples, width), out);
      }
    }
  }
  return box;
}

}  // namespace talus
