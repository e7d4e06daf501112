#include "core/strata/terraces.hpp"

#include <algorithm>
#include <cmath>

#ifndef TALUS_TERRACE_TABLES
#define TALUS_TERRACE_TABLES
namespace talus {

/// Slices of one metre of kStackDepth, and two more for the interpolation at its end.
inline constexpr int kTerraceSlices = static_cast<int>(kStackDepth) + 2;

}  // namespace talus
#endif  // TALUS_TERRACE_TABLES

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/strata/terraces.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/strata/set_blend-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void terrace_row_target(const float* table, const float* steepness, const TerraceRow& r) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t i = 0; i < r.width; i += hn::Lanes(d)) {
    const V weight = hn::LoadU(d, r.weight + i);
    const auto some = hn::Gt(weight, hn::Zero(d));
    if (hn::AllFalse(d, some)) continue;
    const V stack = hn::LoadU(d, r.stack_m + i);
    const V height = hn::LoadU(d, r.height_m + i);
    const V depth = hn::Min(hn::Max(hn::Sub(stack, height), hn::Zero(d)), hn::Set(d, kStackDepth));
    const V whole = hn::Floor(depth);
    const V f = hn::Sub(depth, whole);
    const SetBlend<V> sets = set_blend(d, hn::LoadU(d, r.choice + i));
    const auto first = hn::Add(hn::Mul(sets.set, hn::Set(di, kTerraceSlices)), hn::ConvertTo(di, whole));
    const auto second = hn::Add(first, hn::Set(di, kTerraceSlices));
    const auto at = [&](const float* from) {
      return mix(hn::GatherIndex(d, from, first), hn::GatherIndex(d, from, second), sets.share);
    };
    // The slope is linear between slices, the depth its integral: without a kink, which would be a crack after erosion.
    const V low = at(steepness);
    const V rise = hn::Sub(at(steepness + 1), low);
    const V half_rise = hn::Mul(rise, hn::Set(d, 0.5f));
    const V remapped = hn::Add(at(table), hn::Mul(f, hn::Add(low, hn::Mul(f, half_rise))));
    const V slope = hn::Add(low, hn::Mul(f, rise));

    const V change = hn::Sub(depth, remapped);
    const V factor = hn::Add(hn::Set(d, 1.0f), hn::Mul(weight, hn::Sub(slope, hn::Set(d, 1.0f))));
    const auto store = [&](V before, V after, float* to) {
      hn::StoreU(hn::IfThenElse(some, after, before), d, to + i);
    };
    store(height, hn::Add(height, hn::Mul(weight, change)), r.height_m);
    const V sx = hn::LoadU(d, r.slope_x + i);
    const V sz = hn::LoadU(d, r.slope_z + i);
    store(sx, hn::Add(hn::Mul(sx, factor), hn::Mul(change, hn::LoadU(d, r.weight_x + i))), r.slope_x);
    store(sz, hn::Add(hn::Mul(sz, factor), hn::Mul(change, hn::LoadU(d, r.weight_z + i))), r.slope_z);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(terrace_row_target);

namespace {

/// Rock within this of a depth decides its steepness, in metres: beds blur into formations.
constexpr int kNear = 5;
/// Steepness is over the mean within this of a depth, in metres.
constexpr int kAround = 140;
constexpr double kTread = 0.2;
constexpr double kWall = 5.0;
/// Mean hardness at which a tread begins to steepen, and at which it is a wall.
constexpr double kTreadHardness = 0.50;
constexpr double kWallHardness = 0.80;

/// Means of `values` over the slices within `reach` of each.
std::vector<double> windowed(const std::vector<double>& values, int reach) {
  std::vector<double> sums{0.0};
  for (const double v : values) sums.push_back(sums.back() + v);
  const int count = static_cast<int>(values.size());
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const int low = std::max(i - reach, 0);
    const int high = std::min(i + reach + 1, count);
    out.push_back((sums[static_cast<std::size_t>(high)] - sums[static_cast<std::size_t>(low)]) / (high - low));
  }
  return out;
}

}  // namespace

Terraces::Terraces(std::span<const LayerSet> sets) {
  for (const LayerSet& set : sets) tabulate(set);
  // A choice of exactly sets - 1 looks one set further with weight 0: let it read something.
  depth_m_.resize(depth_m_.size() + static_cast<std::size_t>(kTerraceSlices) + 1);
  steepness_.resize(depth_m_.size());
}

void Terraces::tabulate(const LayerSet& set) {
  std::vector<double> hardness;
  for (int slice = 0; slice < kTerraceSlices; ++slice) {
    const float depth = static_cast<float>(slice);
    hardness.push_back(static_cast<double>(set.layer(set.index_at(depth)).hardness));
  }
  std::vector<double> raw;
  for (const double mean : windowed(hardness, kNear)) {
    const double t = std::clamp((mean - kTreadHardness) / (kWallHardness - kTreadHardness), 0.0, 1.0);
    raw.push_back(kTread + (kWall - kTread) * t * t * (3 - 2 * t));
  }
  const std::vector<double> around = windowed(raw, kAround);
  std::vector<double> steepness;
  for (std::size_t i = 0; i < raw.size(); ++i) steepness.push_back(raw[i] / around[i]);
  double total = 0;
  for (std::size_t i = 0; i + 2 < steepness.size(); ++i) total += 0.5 * (steepness[i] + steepness[i + 1]);
  const double scale = static_cast<double>(kStackDepth) / total;
  double depth = 0;
  for (std::size_t i = 0; i < steepness.size(); ++i) {
    depth_m_.push_back(static_cast<float>(depth));
    steepness_.push_back(static_cast<float>(steepness[i] * scale));
    reach_m_ = std::max(reach_m_, static_cast<float>(std::abs(depth - static_cast<double>(i))) + 1.0f);
    if (i + 1 < steepness.size()) depth += 0.5 * (steepness[i] + steepness[i + 1]) * scale;
  }
}

void Terraces::row(const TerraceRow& row) const {
  HWY_DYNAMIC_DISPATCH(terrace_row_target)(depth_m_.data(), steepness_.data(), row);
}

}  // namespace talus
#endif  // HWY_ONCE
