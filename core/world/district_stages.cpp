#include "core/world/district_stages.hpp"

#include <algorithm>

#include "core/world/relief.hpp"

namespace talus {
namespace {

/// What districts leave to the large gullies.
constexpr float kLeftBadlands = 0.35f;
constexpr float kLeftDunes = 0.0f;
constexpr float kLeftMesas = 0.25f;
constexpr float kLeftKarst = 0.15f;
/// Rills in each, as a share of those of badlands.
constexpr float kRillsMesas = 0.5f;
constexpr float kRillsKarst = 0.25f;

std::span<const float> weight(const DistrictStages& stages, District district) {
  return stages.weights[district].v;
}

}  // namespace

DistrictStages::DistrictStages(Arrays& arrays, const ColumnGrid& grid, ColumnBlock& out) {
  for (std::size_t k = 0; k < kDistricts; ++k) {
    out.district[k].resize(sample_count(grid));
    weights.of[k] = {out.district[k], arrays.span(arrays.take()), arrays.span(arrays.take())};
  }
  weights.folded = arrays.span(arrays.take());
  rills = arrays.jet();
  rill_strength = arrays.span(arrays.take());
  shore_x = arrays.span(arrays.take());
  shore_z = arrays.span(arrays.take());
}

void raise_landforms(const WorldFunction::Terms& t, const GroundArrays& ground, std::span<const float> hilliness,
                     std::span<const float> fade, const ColumnGrid& grid, const Arrays& arrays,
                     DistrictStages& stages) {
  const auto workspace = arrays.borrow(kDistrictBorrowed);
  DistrictWeights& w = stages.weights;
  district_weights(t.districts, grid, ground, hilliness, workspace, w);
  // Rills and terraces down at the sea's level would each be a cliff of their own.
  for (std::size_t i = 0; i < sample_count(grid); ++i) {
    const float left = 1.0f - w.of[0].v[i] - w.of[1].v[i] - w.of[2].v[i] - w.of[3].v[i];
    stages.shore_x[i] = ground.slope_x[i] * left;
    stages.shore_z[i] = ground.slope_z[i] * left;
  }
  std::ranges::copy(fade, stages.rills.v.begin());
  if (w.has(District::kBadlands)) {
    badlands(t.badlands, grid, w[District::kBadlands], ground, stages.rills, workspace);
  }
  if (w.has(District::kMesas)) mesas(t.mesas, grid, w[District::kMesas], ground, workspace);
  if (w.has(District::kKarst)) karst(t.karst, grid, w[District::kKarst], ground, workspace);
  stages.any_rills = w.has(District::kBadlands) || w.has(District::kMesas) || w.has(District::kKarst);
}

void lay_tables(const WorldFunction::Terms& t, const DistrictStages& stages, const GroundArrays& ground,
                ColumnBlock& out) {
  for (std::size_t i = 0; i < sample_count(out.grid); ++i) {
    out.stack_m[i] = kStackTop + (out.stack_m[i] - kStackTop) * stages.weights.folded[i];
  }
  if (!stages.weights.has(District::kMesas)) return;
  const JetArrays& w = stages.weights[District::kMesas];
  const auto width = static_cast<std::size_t>(out.grid.width);
  for (std::size_t at = 0; at < sample_count(out.grid); at += out.stride) {
    t.terraces->row({&out.stack_m[at], &out.choice[at], &w.v[at], &w.x[at], &w.z[at], &ground.height_m[at],
                     &ground.slope_x[at], &ground.slope_z[at], width});
  }
}

void share_erosion(float frequency_everywhere, DistrictStages& stages, std::span<float> strength,
                   std::span<float> frequency_share) {
  const auto leave = [&](District district, float left) {
    if (!stages.weights.has(district)) return;
    const auto w = weight(stages, district);
    for (std::size_t i = 0; i < strength.size(); ++i) strength[i] *= 1.0f - (1.0f - left) * w[i];
  };
  leave(District::kBadlands, kLeftBadlands);
  leave(District::kDunes, kLeftDunes);
  leave(District::kMesas, kLeftMesas);
  leave(District::kKarst, kLeftKarst);
  if (stages.any_rills) {
    const auto bad = weight(stages, District::kBadlands);
    const auto mesa = weight(stages, District::kMesas);
    const auto tower = weight(stages, District::kKarst);
    for (std::size_t i = 0; i < strength.size(); ++i) {
      stages.rill_strength[i] = bad[i] + mesa[i] * kRillsMesas + tower[i] * kRillsKarst;
    }
  }
  const auto ice = weight(stages, District::kGlacial);
  for (std::size_t i = 0; i < frequency_share.size(); ++i) {
    frequency_share[i] = frequency_everywhere + (1.0f - frequency_everywhere) * ice[i];
  }
}

void add_rills(const WorldFunction::Terms& t, const DistrictStages& stages, const GroundArrays& relief,
               const ErodedArrays& eroded, const Arrays& arrays, ColumnBlock& out) {
  if (!stages.any_rills) return;
  const std::size_t count = sample_count(out.grid);
  const auto workspace = arrays.borrow(9);
  const auto array = [&](std::size_t n) { return workspace.subspan(n * count, count); };
  const auto bad = weight(stages, District::kBadlands);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = relief.slope_x[i];
    const float z = relief.slope_z[i];
    array(4)[i] = bad[i] > 0 ? x + (stages.rills.x[i] - x) * bad[i] : x;
    array(5)[i] = bad[i] > 0 ? z + (stages.rills.z[i] - z) * bad[i] : z;
  }
  erode(t.rills, out.grid, {array(4), array(5), stages.rills.v, stages.rill_strength},
        {array(0), array(1), array(2), array(3), array(6), array(7), array(8)});
  for (std::size_t i = 0; i < count; ++i) {
    eroded.change.height_m[i] += array(0)[i];
    eroded.change.slope_x[i] += array(1)[i];
    eroded.change.slope_z[i] += array(2)[i];
    eroded.cut.height_m[i] += array(6)[i];
    eroded.cut.slope_x[i] += array(7)[i];
    eroded.cut.slope_z[i] += array(8)[i];
    const float w = std::min(stages.rill_strength[i], 1.0f);
    if (w > 0) out.ridge[i] += (array(3)[i] - out.ridge[i]) * w;
  }
}

void show_ledges(const DistrictStages& stages, std::span<float> shown) {
  for (const District district : {District::kBadlands, District::kMesas}) {
    if (!stages.weights.has(district)) continue;
    const auto w = weight(stages, district);
    for (std::size_t i = 0; i < shown.size(); ++i) shown[i] += w[i];
  }
}

}  // namespace talus
