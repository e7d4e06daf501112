#include "core/landforms/district.hpp"

#include <algorithm>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_DISTRICT_ROW
#define TALUS_DISTRICT_ROW
namespace talus {

/// The noise of the first two districts and of the next two; the sum of both is that of glaciers. `fringe` frays both.
struct DistrictRow {
  std::array<const float*, 3> first, second, fringe, height;  ///< value and slopes
  const float* hilliness;
  float* folded;
  std::array<std::array<float*, 3>, kDistricts> out;
};

/// Under table land and badlands layers keep this little of their folds and tilt. Around them they rise to it over this
/// many half widths of a border, and whatever the ground there: a wall is cut through layers, it does not bend them.
inline constexpr float kFlatMesas = 0.15f;
inline constexpr float kFlatBadlands = 0.45f;
inline constexpr float kFlatReach = 3.0f;
/// How far borders are frayed, in units of the noise.
inline constexpr float kFringe = 0.14f;

struct DistrictTerms {
  std::array<float, kDistricts> threshold;
  float border;
};

}  // namespace talus
#endif  // TALUS_DISTRICT_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/district.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bit k of the result: some lane of district k has weight.
unsigned district_row(const DistrictTerms& t, const DistrictRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const Jet<V> one{hn::Set(d, 1.0f), hn::Zero(d), hn::Zero(d)};
  unsigned present = 0;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto load = [&](const std::array<const float*, 3>& a) {
      return Jet<V>{hn::LoadU(d, a[0] + i), hn::LoadU(d, a[1] + i), hn::LoadU(d, a[2] + i)};
    };
    const auto above = [&](District k, const Jet<V>& noise) {
      const float threshold = t.threshold[static_cast<std::size_t>(k)];
      return smoothstep(threshold - t.border, threshold + t.border, noise);
    };
    const Jet<V> calm_a = load(r.first);
    const Jet<V> calm_b = load(r.second);
    const Jet<V> fringe = load(r.fringe) * kFringe;
    const Jet<V> a = calm_a + fringe;
    const Jet<V> b = calm_b + fringe;
    const Jet<V> height = load(r.height);
    const Jet<V> hilliness{hn::LoadU(d, r.hilliness + i), hn::Zero(d), hn::Zero(d)};

    const Jet<V> low = one - smoothstep(0.28f, 0.6f, hilliness);
    const Jet<V> flat = one - smoothstep(0.12f, 0.34f, hilliness);
    const Jet<V> dry = smoothstep(6.0f, 36.0f, height);
    // Tower karst stands in shallow seas as well.
    const Jet<V> shore = smoothstep(-30.0f, -4.0f, height);
    const Jet<V> back_beach = smoothstep(2.0f, 6.0f, height) * (one - smoothstep(9.0f, 22.0f, height)) * flat;
    const Jet<V> range = smoothstep(0.45f, 0.75f, hilliness) * smoothstep(180.0f, 520.0f, height);

    std::array<Jet<V>, kDistricts> w;
    w[0] = above(District::kBadlands, a);
    w[1] = above(District::kDunes, a * -1.0f) * (one - w[0]);
    const Jet<V> free = one - w[0] - w[1];
    w[2] = above(District::kMesas, b) * free;
    w[3] = above(District::kKarst, b * -1.0f) * (free - w[2]);
    w[0] = w[0] * low * dry;
    w[1] = w[1] * flat * dry;
    w[2] = w[2] * low * dry;
    w[3] = w[3] * low * shore;
    // Where nothing else rules, low dunes lie behind beaches; a world without dunes has none of either.
    if (t.threshold[1] < 9.0f) {
      w[1] = w[1] + back_beach * (one - w[0] - w[1] - w[2] - w[3]) * 0.3f;
    }
    // 0.7071: the sum of two like noises is as wide as either.
    w[4] = above(District::kGlacial, (a + b) * 0.70710678f) * range;
    const auto flat_around = [&](District k, const Jet<V>& noise, float left) {
      const float threshold = t.threshold[static_cast<std::size_t>(k)];
      const Jet<V> near = smoothstep(threshold - kFlatReach * t.border, threshold + t.border, noise);
      return hn::Sub(one.v, hn::Mul(near.v, hn::Set(d, 1.0f - left)));
    };
    hn::StoreU(hn::Mul(flat_around(District::kBadlands, calm_a, kFlatBadlands),
                       flat_around(District::kMesas, calm_b, kFlatMesas)),
               d, r.folded + i);
    for (std::size_t k = 0; k < kDistricts; ++k) {
      const auto some = hn::Gt(w[k].v, hn::Zero(d));
      if (!hn::AllFalse(d, some)) present |= 1U << k;
      hn::StoreU(w[k].v, d, r.out[k][0] + i);
      hn::StoreU(w[k].x, d, r.out[k][1] + i);
      hn::StoreU(w[k].z, d, r.out[k][2] + i);
    }
  }
  return present;
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(district_row);

namespace {

/// The two noises: two octaves, so that districts have bays and outliers.
constexpr double kDistrictGain = 0.35;
/// Wavelength of what frays their borders, as a share of theirs: 3 km, 1.3 km and 570 m of 15 km.
constexpr double kFringeShare = 0.2;
/// A threshold no noise reaches: the district is nowhere.
constexpr float kNowhere = 10.0f;

/// Values that such a noise exceeds on these shares of a large area, measured on 1.5 million points of 60
/// seeds; linear between them.
struct Quantile {
  double share, value;
};
constexpr std::array<Quantile, 14> kQuantiles{{{0.002, 0.8418},
                                               {0.005, 0.7598},
                                               {0.01, 0.6910},
                                               {0.02, 0.6150},
                                               {0.05, 0.4935},
                                               {0.1, 0.3823},
                                               {0.15, 0.3068},
                                               {0.2, 0.2473},
                                               {0.25, 0.1970},
                                               {0.3, 0.1523},
                                               {0.35, 0.1117},
                                               {0.4, 0.0734},
                                               {0.45, 0.0364},
                                               {0.5, 0.0}}};

}  // namespace

double district_threshold(double share) {
  TALUS_CHECK(share > 0 && share < 1);
  if (share > 0.5) return -district_threshold(1 - share);
  for (std::size_t i = 1; i < kQuantiles.size(); ++i) {
    const Quantile& a = kQuantiles[i - 1];
    const Quantile& b = kQuantiles[i];
    if (share <= b.share) return a.value + (b.value - a.value) * (share - a.share) / (b.share - a.share);
  }
  return 0;
}

void district_weights(const DistrictControls& c, const ColumnGrid& grid, const GroundArrays& ground,
                      std::span<const float> hilliness, std::span<float> workspace, DistrictWeights& weights) {
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(workspace.size() >= kDistrictArrays * count && weights.folded.size() >= count);
  std::array<std::span<float>, kDistrictArrays> noise;
  for (std::size_t n = 0; n < kDistrictArrays; ++n) noise[n] = workspace.subspan(n * count, count);
  fractal_noise({c.wavelength_m, 2, 2.1, kDistrictGain, mix64(c.seed, 0)}, grid, noise[0], noise[1], noise[2]);
  fractal_noise({c.wavelength_m, 2, 2.1, kDistrictGain, mix64(c.seed, 1)}, grid, noise[3], noise[4], noise[5]);
  fractal_noise({c.wavelength_m * kFringeShare, 3, 2.3, 0.5, mix64(c.seed, 2)}, grid, noise[6], noise[7], noise[8]);

  DistrictTerms terms{};
  terms.border = static_cast<float>(c.border);
  // The second noise's districts get what the first's leave: their thresholds make up for it.
  const double left = 1 - c.share[0] - c.share[1];
  for (std::size_t k = 0; k < kDistricts; ++k) {
    const double share = k == 2 || k == 3 ? std::min(c.share[k] / left, 0.6) : c.share[k];
    terms.threshold[k] = c.share[k] > 0 ? static_cast<float>(district_threshold(share)) : kNowhere;
  }
  const std::size_t stride = row_stride(grid);
  const auto row = HWY_DYNAMIC_DISPATCH(district_row);
  unsigned present = 0;
  for (std::size_t at = 0; at < count; at += stride) {
    DistrictRow r{{&noise[0][at], &noise[1][at], &noise[2][at]},
                  {&noise[3][at], &noise[4][at], &noise[5][at]},
                  {&noise[6][at], &noise[7][at], &noise[8][at]},
                  {&ground.height_m[at], &ground.slope_x[at], &ground.slope_z[at]},
                  &hilliness[at],
                  &weights.folded[at],
                  {}};
    for (std::size_t k = 0; k < kDistricts; ++k) {
      r.out[k] = {&weights.of[k].v[at], &weights.of[k].x[at], &weights.of[k].z[at]};
    }
    present |= row(terms, r, static_cast<std::size_t>(grid.width));
  }
  for (std::size_t k = 0; k < kDistricts; ++k) weights.present[k] = (present >> k & 1U) != 0;
}

}  // namespace talus
#endif  // HWY_ONCE
