#include "core/volume/field.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"
#include "core/noise/solid_noise.hpp"
#include "core/volume/field_rows.hpp"
#include "core/volume/warp.hpp"

namespace talus {
namespace {

constexpr std::array<double, kRoughOctaves> kRoughWave_m{4.0, 2.0};
constexpr std::array<float, kRoughOctaves> kRoughAmplitude{1.0f, 0.5f};
/// A wall so far away that no smooth minimum feels it.
constexpr float kFarAway_m = 1e9f;

Octave rough_octave(const CarveControls& controls, const ColumnGrid& grid, std::size_t n) {
  return octave_on(grid, 1.0 / kRoughWave_m[n], mix64(controls.seed, 0x0A11 + n));
}

/// Distance to the next multiple of kStill_m.
float to_still(double at_m) {
  return static_cast<float>(std::abs(at_m - kStill_m * std::floor(at_m / kStill_m + 0.5)));
}

/// Height of a sample above the pillars' stumps or below where they hang: 0 where pillars stand whole.
float to_pillars(float y_m) {
  constexpr auto kLevel = static_cast<float>(kStill_m);
  return y_m > 0.0f && y_m < kLevel ? std::min(y_m, kLevel - y_m) : 0.0f;
}

}  // namespace

Field::Field(const HardnessProfile& profile, const CarveControls& controls, const FieldColumns& columns,
             FieldMemory& memory)
    : profile_(profile),
      controls_(controls),
      columns_(columns),
      memory_(memory),
      stride_(row_stride(columns.grid)),
      width_(static_cast<std::size_t>(columns.grid.width)),
      step_m_(static_cast<float>(static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m)) {
  const ColumnGrid& grid = columns.grid;
  for (std::size_t i = 0; i < stride_; ++i) {
    const double x_m =
        static_cast<double>(grid.x_voxel + static_cast<std::int64_t>(i) * grid.step_voxel) * grid.voxel_m;
    memory.still_x[i] = to_still(x_m);
  }
  if (columns.spheres.empty()) return;
  for (std::size_t n = 0; n < kRoughOctaves; ++n) {
    const Octave octave = rough_octave(controls, grid, n);
    split_axis(octave, 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, 0, 2, memory.rough[n].x);
    split_axis(octave, 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, 0, 2, memory.rough[n].z);
  }
}

void Field::layer(std::int64_t y_voxel) {
  const ColumnGrid& grid = columns_.grid;
  const double y_m = static_cast<double>(y_voxel) * grid.voxel_m;
  y_m_ = static_cast<float>(y_m);
  still_y_ = to_still(y_m);
  memory_.layer_spheres.clear();
  for (std::size_t n = 0; n < columns_.spheres.size(); ++n) {
    const CarveSphere& s = columns_.spheres[n];
    if (std::abs((y_m_ - s.y_m) * s.inverse_stretch) < s.radius_m + kCarveBand_m)
      memory_.layer_spheres.push_back(static_cast<std::uint32_t>(n));
  }
  if (memory_.layer_spheres.empty()) return;
  for (std::size_t n = 0; n < kRoughOctaves; ++n)
    split_axis(rough_octave(controls_, grid, n), 2, y_voxel, grid.step_voxel, grid.voxel_m, 1, 0, 2,
               memory_.rough_y[n]);
}

void Field::base_row(int k, const Span& span, float* out) {
  const std::size_t at = static_cast<std::size_t>(k) * stride_ + span.first;
  const float* height = columns_.height_m + at;
  const float* steepness = columns_.steepness + at;
  if (columns_.jut_m == nullptr) {
    smooth_row(y_m_, height, steepness, span.size(), out);
    return;
  }
  profile_.row(columns_.stack_m + at, columns_.choice + at, y_m_, span.size(), memory_.proud.data());
  const double z_m = static_cast<double>(columns_.grid.z_voxel + k * columns_.grid.step_voxel) * columns_.grid.voxel_m;
  const float still_z = to_still(z_m);
  const float still2 = still_y_ * still_y_ + still_z * still_z;
  const bool is_near = still2 < kWarpStillRadius_m * kWarpStillRadius_m;
  warped_row(y_m_,
             {height, steepness, columns_.jut_m + at, memory_.proud.data(),
              is_near ? memory_.still_x.data() + span.first : nullptr, still2},
             span.size(), out);
}

/// Joins one sphere to the distances of a part of a row; false where it does not reach it.
bool Field::carve_row(int k, const CarveSphere& s, const Span& span) {
  const ColumnGrid& grid = columns_.grid;
  const auto metres = [&](std::int64_t voxel) { return static_cast<double>(voxel) * grid.voxel_m; };
  const auto dz = static_cast<float>(metres(grid.z_voxel + k * grid.step_voxel) - s.z_m);
  const float dy = (y_m_ - s.y_m) * s.inverse_stretch;
  const float rest2 = dy * dy + dz * dz;
  const float reach = s.radius_m + kCarveBand_m;
  if (!(rest2 < reach * reach)) return false;
  const auto dx = static_cast<float>(metres(grid.x_voxel) - s.x_m);
  const float half = std::sqrt(reach * reach - rest2);
  // Samples a little outside cost nothing but time: each asks for itself whether it is within the band.
  const float first = std::floor((-half - dx) / step_m_) - 1.0f;
  const float last = std::floor((half - dx) / step_m_) + 2.0f;
  const auto span_first = static_cast<float>(span.first);
  const auto span_end = static_cast<float>(span.end);
  if (last <= span_first || first >= span_end) return false;
  const auto from = static_cast<std::size_t>(std::max(first, span_first));
  const auto end = static_cast<std::size_t>(std::min(last + 1.0f, span_end));
  sphere_row({dx, step_m_, rest2, s.radius_m, controls_.union_m}, from, end, memory_.carve.data());
  return true;
}

/// The roughness along a part of a row, or null where no wall is near.
const float* Field::rough_row(int k, const Span& span) {
  if (!(controls_.roughness_m > 0.0f) || !any_rough(memory_.carve.data() + span.first, span.size())) return nullptr;
  std::fill_n(memory_.noise.begin(), stride_, 0.0f);
  const auto z = static_cast<std::size_t>(k);
  for (std::size_t n = 0; n < kRoughOctaves; ++n) {
    const FieldMemory::Octave& octave = memory_.rough[n];
    const Axis& y = memory_.rough_y[n];
    add_solid_noise_row({&octave.x,
                         y.fraction[0],
                         octave.z.fraction[z],
                         {y.cell_hash[0][0], y.cell_hash[1][0]},
                         {octave.z.cell_hash[0][z], octave.z.cell_hash[1][z]}},
                        width_, kRoughAmplitude[n], memory_.noise.data());
  }
  return memory_.noise.data() + span.first;
}

void Field::part(int k, std::size_t first, std::size_t end, float* out) {
  const Span span{first, end};
  out += first;
  base_row(k, span, out);
  if (memory_.layer_spheres.empty()) return;
  const std::size_t whole_vectors = (span.size() + kRowPadding - 1) / kRowPadding * kRowPadding;
  std::fill_n(memory_.carve.begin() + static_cast<std::ptrdiff_t>(first), whole_vectors, kFarAway_m);
  bool is_carved = false;
  for (const std::uint32_t n : memory_.layer_spheres) is_carved = carve_row(k, columns_.spheres[n], span) || is_carved;
  if (!is_carved) return;
  const double z_m = static_cast<double>(columns_.grid.z_voxel + k * columns_.grid.step_voxel) * columns_.grid.voxel_m;
  const std::size_t at = static_cast<std::size_t>(k) * stride_ + first;
  subtract_row({memory_.carve.data() + first, memory_.still_x.data() + first, to_still(z_m), to_pillars(y_m_),
                rough_row(k, span), controls_.roughness_m, controls_.blend_m, y_m_, columns_.height_m + at,
                columns_.jut_m == nullptr ? nullptr : columns_.jut_m + at},
               span.size(), out);
}

}  // namespace talus
