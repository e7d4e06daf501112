#include "core/volume/warp.hpp"

#include <algorithm>
#include <cmath>

#include "core/noise/gradient_noise.hpp"
#include "core/volume/carve_spheres.hpp"

namespace talus {
namespace {

float smooth(float low, float high, float v) {
  const float t = std::clamp((v - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - (t + t));
}

/// Places differ in how much of their beds shows: this share at least.
constexpr float kPatchShare = 0.35f;

/// Columns of the fan up the slope. Fewer would step over the crest of a fin from one side of it and not from the
/// other.
constexpr int kFanColumns = 3;
/// Where beds show more than this, they bridge joints wholly.
constexpr float kBridging = 0.25f;

/// The highest that the surface rises over the fan: `reach` slopes up from a column.
float highest_of_fan(Relief& relief, double x_m, double z_m, const ReliefPoint& here, float reach) {
  float highest_m = here.height_m;
  for (int n = 1; n <= kFanColumns; ++n) {
    const float part = reach * (static_cast<float>(n) / kFanColumns);
    highest_m = std::max(highest_m, relief.height_at(x_m + static_cast<double>(here.slope_x * part),
                                                     z_m + static_cast<double>(here.slope_z * part)));
  }
  return highest_m;
}

/// Noise of one octave, with its slopes, which nobody reads.
void fill_patch(const WarpControls& controls, const ColumnGrid& grid, std::vector<float>& memory) {
  const std::size_t count = sample_count(grid);
  memory.resize(std::max(memory.size(), 3 * count));
  const std::span<float> all(memory);
  fractal_noise({controls.patch_m, 1, 2.0, 0.5, controls.seed}, grid, all.subspan(0, count), all.subspan(count, count),
                all.subspan(2 * count, count));
}

}  // namespace

bool warp_columns(const WarpControls& controls, Relief& relief, const ColumnGrid& grid, const float* height,
                  std::vector<float>& patch, float* jut) {
  const std::size_t stride = row_stride(grid);
  std::fill_n(jut, sample_count(grid), 0.0f);
  if (!(controls.reach_m > 0.0f) || lies_on(grid, kStill_m)) return false;
  const auto tile = [](double at) { return static_cast<std::int64_t>(std::floor(at / kFineTile_m)); };
  bool any = false;
  std::int64_t known_x = 0;
  std::int64_t known_z = 0;
  bool known = false;
  bool is_steep = false;
  for (int k = 0; k < grid.depth; ++k) {
    const double z_m = static_cast<double>(grid.z_voxel + k * grid.step_voxel) * grid.voxel_m;
    for (int i = 0; i < grid.width; ++i) {
      const double x_m = static_cast<double>(grid.x_voxel + i * grid.step_voxel) * grid.voxel_m;
      if (!known || tile(x_m) != known_x || tile(z_m) != known_z) {
        known = true;
        known_x = tile(x_m);
        known_z = tile(z_m);
        is_steep = relief.outlook(known_x, known_z).rise > kStillRise;
      }
      if (!is_steep) continue;
      const float gate = relief.gate_at(x_m, z_m);
      if (!(gate > 0.0f)) continue;
      const ReliefPoint here = relief.at(x_m, z_m);
      const float slope = std::sqrt(here.slope_x * here.slope_x + here.slope_z * here.slope_z);
      const float shown = smooth(controls.slope_low, controls.slope_high, slope) * gate;
      if (!(shown > 0.0f)) continue;
      const float highest_m = highest_of_fan(relief, x_m, z_m, here, controls.reach_m / slope);
      const std::size_t at = static_cast<std::size_t>(k) * stride + static_cast<std::size_t>(i);
      if (!any) fill_patch(controls, grid, patch);
      const float share = kPatchShare + (1.0f - kPatchShare) * smooth(-0.25f, 0.3f, patch[at]);
      any = true;
      // To what beds reach by the relief between nodes, whatever the column's own joints and boulders: a bed bridges
      // them. One that followed them, or reached less far from a joint's floor, would fall to pieces.
      const float reached = here.height_m + (highest_m - here.height_m) * shown * share;
      jut[at] = std::max(reached - height[at], 0.0f) * std::min(shown / kBridging, 1.0f);
    }
  }
  return any;
}

}  // namespace talus
