#include "core/strata/hardness_profile.hpp"

#include <algorithm>
#include <cmath>

#ifndef TALUS_HARDNESS_PROFILE_SLICES
#define TALUS_HARDNESS_PROFILE_SLICES
namespace talus {

/// Half-metre slices of kStackDepth, and one more for the interpolation at its end.
inline constexpr float kProudSlicesPerMetre = 2.0f;
inline constexpr int kProudSlices = static_cast<int>(kStackDepth * kProudSlicesPerMetre) + 2;

}  // namespace talus
#endif  // TALUS_HARDNESS_PROFILE_SLICES

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/strata/hardness_profile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void proud_row_target(const float* HWY_RESTRICT table, const float* HWY_RESTRICT stack,
                      const float* HWY_RESTRICT choice, float height_m, std::size_t width, float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  using V = hn::Vec<decltype(d)>;
  const V height = hn::Set(d, height_m);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V depth = hn::Min(hn::Max(hn::Sub(hn::LoadU(d, stack + i), height), hn::Zero(d)), hn::Set(d, kStackDepth));
    const V slices = hn::Mul(depth, hn::Set(d, kProudSlicesPerMetre));
    const V whole = hn::Floor(slices);
    const V f = hn::Sub(slices, whole);
    const V where = hn::LoadU(d, choice + i);
    const V set = hn::Floor(where);
    // Sets change over within 0.35 .. 0.65 of the way, as they do for erosion and ledges.
    const V t = saturate(hn::Mul(hn::Sub(hn::Sub(where, set), hn::Set(d, 0.35f)), hn::Set(d, 1.0f / 0.3f)));
    const V blend = hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t)));
    const auto at = hn::Add(hn::Mul(hn::ConvertTo(di, set), hn::Set(di, kProudSlices)), hn::ConvertTo(di, whole));
    const auto next_set = hn::Add(at, hn::Set(di, kProudSlices));
    const V here = mix(hn::GatherIndex(d, table, at), hn::GatherIndex(d, table, next_set), blend);
    const V below = mix(hn::GatherIndex(d, table + 1, at), hn::GatherIndex(d, table + 1, next_set), blend);
    hn::StoreU(mix(here, below, f), d, out + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(proud_row_target);

namespace {

/// Hardness from which a bed starts to stand proud, and from which it does so fully: shale and mudstone stay back,
/// sandstones stand out by half or more, massive limestone, basalt and granite fully.
constexpr float kBack = 0.25f;
constexpr float kProud = 0.75f;

/// Steps of 1/8 m in which layers are averaged; the triangle of +-3/4 m has 13 of them, with weights 0 1 2 .. 6 .. 2 1
/// 0. With +-1/2 m the thin beds of a steep flank meet voxels in a waffle.
constexpr int kStepsPerMetre = 8;
constexpr int kTriangleSteps = 6;
constexpr int kStepsPerSlice = kStepsPerMetre / static_cast<int>(kProudSlicesPerMetre);

/// A ceiling, in slices: how far it is looked for, the hard bed over it, the soft one under it; and how much they must
/// differ.
constexpr int kCeilingReach = 32;
constexpr int kCeilingHard = 6;
constexpr int kCeilingSoft = 5;
constexpr float kCeilingStep = 0.35f;

}  // namespace

HardnessProfile::HardnessProfile(const Strata& strata) {
  for (int n = 0; n < strata.sets(); ++n) tabulate(strata.set(n));
  proud_.resize(proud_.size() + static_cast<std::size_t>(kProudSlices) + 1);
}

void HardnessProfile::tabulate(const LayerSet& set) {
  const int steps = (kProudSlices - 1) * kStepsPerSlice + 1;
  std::vector<float> proud;
  int index = 0;
  for (int n = 0; n < steps; ++n) {
    const float depth_m = static_cast<float>(n) / static_cast<float>(kStepsPerMetre);
    while (index + 1 < kLayers && set.top_m(index + 1) <= depth_m) ++index;
    proud.push_back(std::clamp((set.layer(index).hardness - kBack) / (kProud - kBack), 0.0f, 1.0f));
  }
  for (int slice = 0; slice < kProudSlices; ++slice) {
    float sum = 0;
    for (int n = -kTriangleSteps; n <= kTriangleSteps; ++n) {
      const int at = std::clamp(slice * kStepsPerSlice + n, 0, steps - 1);
      sum += static_cast<float>(kTriangleSteps - std::abs(n)) * proud[static_cast<std::size_t>(at)];
    }
    proud_.push_back(sum / static_cast<float>(kTriangleSteps * kTriangleSteps));
  }
}

std::optional<float> HardnessProfile::ceiling_near(float stack_m, float choice, float height_m) const {
  constexpr float kLast = static_cast<float>(kProudSlices - 1 - kCeilingReach - kCeilingSoft);
  const float slices = std::floor((stack_m - height_m) * kProudSlicesPerMetre);
  if (!(slices >= static_cast<float>(kCeilingReach + kCeilingHard) && slices <= kLast)) return std::nullopt;
  const int middle = static_cast<int>(slices);
  const std::size_t sets = proud_.size() / static_cast<std::size_t>(kProudSlices) - 1;
  const auto set = std::min(static_cast<std::size_t>(std::max(choice, 0.0f) + 0.5f), sets - 1);
  const float* const table = &proud_[set * static_cast<std::size_t>(kProudSlices)];
  const auto mean = [table](int from, int count) {
    float sum = 0;
    for (int n = from; n < from + count; ++n) sum += table[n];
    return sum / static_cast<float>(count);
  };
  float most = kCeilingStep;
  int found = 0;
  bool any = false;
  for (int at = middle - kCeilingReach; at <= middle + kCeilingReach; ++at) {
    const float step = mean(at - kCeilingHard, kCeilingHard) - mean(at, kCeilingSoft);
    if (!(step > most)) continue;
    most = step;
    found = at;
    any = true;
  }
  if (!any) return std::nullopt;
  return stack_m - static_cast<float>(found) / kProudSlicesPerMetre;
}

void HardnessProfile::row(const float* stack_m, const float* choice, float height_m, std::size_t width,
                          float* out) const {
  HWY_DYNAMIC_DISPATCH(proud_row_target)(proud_.data(), stack_m, choice, height_m, width, out);
}

}  // namespace talus
#endif  // HWY_ONCE
