#include "core/strata/strata.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/strata/layer_search.hpp"

#ifndef TALUS_STRATA_TABLES
#define TALUS_STRATA_TABLES
namespace talus {

/// Half-metre slices of kStackDepth, and one more for the interpolation at its end.
inline constexpr float kSlicesPerMetre = 2.0f;
inline constexpr int kSlicesPerSet = static_cast<int>(kStackDepth * kSlicesPerMetre) + 2;

/// What the kernels read.
struct StrataTables {
  const float *ledge_a, *ledge_b;
  float ledge_scale, ledge_slope;
};

}  // namespace talus
#endif  // TALUS_STRATA_TABLES

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/strata/strata.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"
#include "core/strata/set_blend-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A table's value and slope per metre of depth, blended between the two sets that meet at each lane.
template <class D, class V = VecOf<D>>
HWY_INLINE void look_up(D d, const float* table, V depth, V choice, V& value, V& slope) {
  const hn::RebindToSigned<D> di;
  const V slices = hn::Mul(hn::Min(hn::Max(depth, hn::Zero(d)), hn::Set(d, kStackDepth)), hn::Set(d, kSlicesPerMetre));
  const V whole = hn::Floor(slices);
  const V f = hn::Sub(slices, whole);
  const SetBlend<V> sets = set_blend(d, choice);
  const auto at = hn::Add(hn::Mul(sets.set, hn::Set(di, kSlicesPerSet)), hn::ConvertTo(di, whole));
  const auto step = [&](int offset, V& low, V& rise) {
    const auto here = hn::Add(at, hn::Set(di, offset));
    low = hn::GatherIndex(d, table, here);
    rise = hn::Sub(hn::GatherIndex(d, table + 1, here), low);
  };
  V low_a, rise_a, low_b, rise_b;
  step(0, low_a, rise_a);
  step(kSlicesPerSet, low_b, rise_b);
  const V rise = mix(rise_a, rise_b, sets.share);
  value = hn::Add(mix(low_a, low_b, sets.share), hn::Mul(f, rise));
  slope = hn::Mul(rise, hn::Set(d, kSlicesPerMetre));
}

void hardness_row_target(const float* table, const StrataRow& r, const float* height, float* hardness) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < r.width; i += hn::Lanes(d)) {
    const auto depth = hn::Sub(hn::LoadU(d, r.stack_m + i), hn::LoadU(d, height + i));
    hn::Vec<decltype(d)> value;
    hn::Vec<decltype(d)> slope;
    look_up(d, table, depth, hn::LoadU(d, r.choice + i), value, slope);
    hn::StoreU(value, d, hardness + i);
  }
}

void ledge_row_target(const StrataTables& tables, const StrataRow& r, const float* relief_x, const float* relief_z,
                      float* height, float* slope_x, float* slope_z) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const auto rising = [&](V v, float low, float high) {
    return smoothstep(low, high, Jet<V>{v, hn::Zero(d), hn::Zero(d)}).v;
  };
  for (std::size_t i = 0; i < r.width; i += hn::Lanes(d)) {
    const V h = hn::LoadU(d, height + i);
    const V gx = hn::LoadU(d, relief_x + i);
    const V gz = hn::LoadU(d, relief_z + i);
    const V steep = hn::Sqrt(hn::Add(hn::Mul(gx, gx), hn::Mul(gz, gz)));
    const V depth = hn::Sub(hn::LoadU(d, r.stack_m + i), h);
    const V choice = hn::LoadU(d, r.choice + i);
    const V fashion = hn::LoadU(d, r.fashion + i);
    V ledge_a, ledge_b, slope_a, slope_b;
    look_up(d, tables.ledge_a, depth, choice, ledge_a, slope_a);
    look_up(d, tables.ledge_b, depth, choice, ledge_b, slope_b);
    const V ledge = mix(ledge_a, ledge_b, fashion);
    const V ledge_slope = mix(slope_a, slope_b, fashion);
    const V shown = hn::Mul(hn::Mul(rising(steep, 0.4f * tables.ledge_slope, 1.6f * tables.ledge_slope),
                                    rising(hn::LoadU(d, r.district + i), -0.25f, 0.2f)),
                            hn::Mul(rising(h, 5.0f, 240.0f), hn::Set(d, tables.ledge_scale)));
    // Depth falls as height rises: d height' / d height = 1 + shown * d ledge / d depth.
    const V factor = hn::Add(hn::Set(d, 1.0f), hn::Mul(shown, ledge_slope));
    hn::StoreU(hn::Sub(h, hn::Mul(shown, ledge)), d, height + i);
    hn::StoreU(hn::Mul(hn::LoadU(d, slope_x + i), factor), d, slope_x + i);
    hn::StoreU(hn::Mul(hn::LoadU(d, slope_z + i), factor), d, slope_z + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(hardness_row_target);
HWY_EXPORT(ledge_row_target);

namespace {

/// A neutral rock: harder ones stand proud, softer ones recede.
constexpr float kNeutralHardness = 0.53f;
/// Ledges forget the layers above after this depth, in metres: a thick hard formation lifts its rim, not a continent.
constexpr float kLeak_m = 80.0f;
constexpr float kWindow_m = 45.0f;
constexpr float kBedWindow_m = 16.0f;
/// Formations take turns in making bold ledges over this depth, in metres, and one out of fashion keeps this share of
/// them: a ledge gives out along a slope and another sets in, above or below.
constexpr double kFashion_m = 90.0;
constexpr double kFashionLow = 0.15;

/// Wavelength of the ragged border between two sets, in metres.
constexpr double kBorder_m = 160.0;
/// Metres to the side by which the border of two rocks, or of two sets, moves per metre of height: it never stands
/// upright.
constexpr double kSlant = 5.0;

/// How much a depth is in the first fashion, 0..1: a noise of its own for each set.
double fashion_at(std::uint64_t seed, double depth_m) {
  const double at = depth_m / kFashion_m;
  const double knot = std::floor(at);
  const auto value = [&](double k) {
    return static_cast<double>(mix64(seed, static_cast<std::uint64_t>(k)) >> 40) * 0x1p-24;
  };
  const double t = at - knot;
  const double between = value(knot) + (value(knot + 1) - value(knot)) * (t * t * (3 - 2 * t));
  return std::clamp(1.8 * (between - 0.5) + 0.5, 0.0, 1.0);
}

/// Share of its ledges that rock keeps: all up to half of the other fashion.
double fashion_share(double other) {
  return std::min(1.0, 1.0 - (1.0 - kFashionLow) * (2.0 * other - 1.0));
}

/// Means of what `sum` sums up, within `window_m` of each slice.
void append_means(const std::vector<double>& sum, float window_m, std::vector<float>& out) {
  const int window = static_cast<int>(window_m * kSlicesPerMetre);
  for (int slice = 0; slice < kSlicesPerSet; ++slice) {
    const int low = std::max(slice - window, 0);
    const int high = std::min(slice + window, kSlicesPerSet);
    const double mean = (sum[static_cast<std::size_t>(high)] - sum[static_cast<std::size_t>(low)]) / (high - low);
    out.push_back(static_cast<float>(mean));
  }
}

glm::dvec2 leaning(const RockPoint& point, double height_m) {
  return {point.place_m.x + kSlant * height_m, point.place_m.y - kSlant * height_m};
}

}  // namespace

Strata::Strata(const StrataControls& controls)
    : controls_(controls), facies_(controls.facies_m, controls.wrap_m), borders_(kBorder_m, controls.wrap_m) {
  TALUS_CHECK(controls.sets >= 2 && controls.ledge <= 1.8f);
  for (int n = 0; n < controls.sets; ++n) {
    const std::uint64_t seed = mix64(controls.seed, static_cast<std::uint64_t>(n));
    sets_.emplace_back(seed);
    tabulate(sets_.back(), mix64(seed));
    dominant_.add(sets_.back());
  }
  // A choice of exactly sets - 1 looks one set further with weight 0: let it read something.
  for (auto* table : {&ledge_a_, &ledge_b_, &hardness_, &bed_hardness_})
    table->resize(table->size() + static_cast<std::size_t>(kSlicesPerSet) + 1);
}

void Strata::tabulate(const LayerSet& set, std::uint64_t seed) {
  std::vector<float> depths;
  depths.reserve(kSlicesPerSet);
  for (int slice = 0; slice < kSlicesPerSet; ++slice) {
    depths.push_back((static_cast<float>(slice) + 0.5f) / kSlicesPerMetre);
  }
  std::vector<std::int32_t> layers(depths.size());
  LayerSearch(set).find(depths, layers);
  std::vector<double> sum{0.0};
  double ledge_a = 0;
  double ledge_b = 0;
  const double step = 1.0 / static_cast<double>(kSlicesPerMetre);
  for (int slice = 0; slice < kSlicesPerSet; ++slice) {
    ledge_a_.push_back(static_cast<float>(ledge_a));
    ledge_b_.push_back(static_cast<float>(ledge_b));
    const auto hardness = static_cast<double>(set.layer(layers[static_cast<std::size_t>(slice)]).hardness);
    const double over = hardness - static_cast<double>(kNeutralHardness);
    const double a = fashion_at(seed, slice * step);
    ledge_a += (over * fashion_share(1.0 - a) - ledge_a / static_cast<double>(kLeak_m)) * step;
    ledge_b += (over * fashion_share(a) - ledge_b / static_cast<double>(kLeak_m)) * step;
    sum.push_back(sum.back() + hardness);
  }
  append_means(sum, kWindow_m, hardness_);
  append_means(sum, kBedWindow_m, bed_hardness_);
}

void Strata::hardness_row(const StrataRow& row, const float* height_m, float* hardness) const {
  HWY_DYNAMIC_DISPATCH(hardness_row_target)(hardness_.data(), row, height_m, hardness);
}

void Strata::bed_hardness_row(const StrataRow& row, const float* height_m, float* hardness) const {
  HWY_DYNAMIC_DISPATCH(hardness_row_target)(bed_hardness_.data(), row, height_m, hardness);
}

void Strata::ledge_row(const StrataRow& row, const float* relief_x, const float* relief_z, float* height_m,
                       float* slope_x, float* slope_z) const {
  HWY_DYNAMIC_DISPATCH(ledge_row_target)
  ({ledge_a_.data(), ledge_b_.data(), controls_.ledge, controls_.ledge_slope}, row, relief_x, relief_z, height_m,
   slope_x, slope_z);
}

int Strata::set_at(const RockPoint& p) const {
  const int last = sets() - 1;
  const int low = std::clamp(static_cast<int>(p.choice), 0, last);
  const float fraction = p.choice - static_cast<float>(low);
  // Beyond these nothing is left to chance; a wide cell takes the larger part.
  float border = 0.5f;
  if (fraction > 0.35f && fraction < 0.65f && p.span_m < kBorder_m)
    border = 0.35f + 0.3f * borders_.quantile(controls_.seed, leaning(p, static_cast<double>(p.height_m)));
  return fraction > border ? std::min(low + 1, last) : low;
}

LayerPlace Strata::layer_at(const RockPoint& point) const {
  const int chosen = set_at(point);
  return {chosen, set(chosen).index_at(point.stack_m - point.height_m)};
}

Material Strata::rock_at(const RockPoint& point) const {
  const float depth_m = point.stack_m - point.height_m;
  if (point.span_m >= DominantRock::kSpanLow_m) return dominant_.at(set_at(point), depth_m, point.span_m);
  const LayerPlace place = layer_at(point);
  const LayerSet& rocks = set(place.set);
  const auto inside_m = static_cast<double>(depth_m - rocks.top_m(place.index));
  const auto name = static_cast<std::uint64_t>(place.set) * kLayers + static_cast<std::uint64_t>(place.index) + 1;
  return rocks.rock_at(place.index, facies_.quantile(mix64(controls_.seed, name), leaning(point, inside_m)));
}

}  // namespace talus
#endif  // HWY_ONCE
