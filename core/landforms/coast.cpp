#include "core/landforms/coast.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_COAST_ROW
#define TALUS_COAST_ROW
namespace talus {

/// Fins and joints are whole within the first distance from sea level and gone beyond the second, in metres. With the
/// manifest's limits they sway by at most 1.6 (1.7 * 15 + 1.41 * 1.5) = 44 m < 70 m / 1.5, so heights stay in order.
inline constexpr float kWrinkleFull_m = 18.0f;
inline constexpr float kWrinkleReach_m = 88.0f;

struct CoastNoise {
  const float *v, *x, *z;
};

enum CoastNoiseUse : std::size_t {
  kDistrict,
  kCliffHeight,
  kFinAlongX,  ///< fins that run along x
  kFinAlongZ,
  kFinPatch,
  kHeadland,
  kJointBroad,
  kJointFine,
  kCoastNoises
};

struct CoastTerms {
  float cliff, cliff_vary, share_shift, cliff_slope, fin, headland, joint, shelf, beach;
};

struct CoastRow {
  std::array<CoastNoise, kCoastNoises> noise;
  const float *relief_x, *relief_z, *hilliness;
  float *height, *slope_x, *slope_z, *cliff, *beach;
};

}  // namespace talus
#endif  // TALUS_COAST_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/coast.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/landforms/cliff-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE Jet<V> magnitude(const Jet<V>& a) {
  return {hn::Abs(a.v), hn::CopySign(a.x, hn::Xor(a.x, a.v)), hn::CopySign(a.z, hn::Xor(a.z, a.v))};
}

/// What a beach adds to the raw height r, for a whole beach. Five steps, each as high as its share of the profile is
/// steeper (+) or flatter (-) than r: they sum to 0, and the flattest of them, the bar's lee, leaves r a slope of 1
/// - 1.5
/// * 1.0 / 1.7 = 0.12.
template <class V>
HWY_INLINE Jet<V> beach_profile(const Jet<V>& r) {
  return smoothstep(kBar_m, kBarCrest_m, r) * 0.5f - smoothstep(kBarCrest_m, kFaceLow_m, r) * 1.0f +
         smoothstep(kFaceLow_m, kFaceHigh_m, r) * 1.1f - smoothstep(kFaceHigh_m, kBerm_m, r) * 1.2f +
         smoothstep(kBerm_m, kDuneFoot_m, r) * 0.6f;
}

/// 0 on coasts that end in beaches, 1 where cliffs stand whole. `steep` and `hilly` are taken as constant.
template <class V>
HWY_INLINE Jet<V> cliffness(const CoastTerms& t, const Jet<V>& district, V steep, V hilly) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d);
  const Jet<V> hinterland{hn::Add(steep, hn::Mul(hilly, hn::Set(d, 0.04f))), zero, zero};
  const Jet<V> hard = smoothstep(0.5f * t.cliff_slope, 1.5f * t.cliff_slope, hinterland);
  return hard * smoothstep(-0.14f, 0.14f, district + t.share_shift);
}

void coast_row(const CoastTerms& t, const CoastRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto noise = [&](CoastNoiseUse use) {
      const CoastNoise& n = r.noise[use];
      return Jet<V>{hn::LoadU(d, n.v + i), hn::LoadU(d, n.x + i), hn::LoadU(d, n.z + i)};
    };
    const Jet<V> eroded{hn::LoadU(d, r.height + i), hn::LoadU(d, r.slope_x + i), hn::LoadU(d, r.slope_z + i)};
    const V hilly = hn::LoadU(d, r.hilliness + i);
    const V gx = hn::LoadU(d, r.relief_x + i);
    const V gz = hn::LoadU(d, r.relief_z + i);
    const V steep2 = hn::Add(hn::Mul(gx, gx), hn::Mul(gz, gz));
    const V steep = hn::Sqrt(steep2);
    const Jet<V> cliff = cliffness(t, noise(kDistrict), steep, hilly);

    // Fins run across the coast: down the relief's slope, as a mix of those along x and along z.
    // Where the relief is level, with slopes below 0.02, both show alike.
    const V level = hn::Set(d, 4e-4f);
    const V along_x = hn::Div(hn::Add(hn::Mul(gx, gx), level), hn::Add(steep2, hn::Add(level, level)));
    const Jet<V> share_x{along_x, zero, zero};
    const Jet<V> share_z{hn::Sub(one, along_x), zero, zero};
    const Jet<V> fins = noise(kFinAlongX) * share_x + noise(kFinAlongZ) * share_z;
    const Jet<V> patch = smoothstep(-0.25f, 0.2f, noise(kFinPatch));
    const Jet<V> joints = magnitude(noise(kJointBroad)) + magnitude(noise(kJointFine)) * 0.41f;
    const Jet<V> near = smoothstep(kWrinkleFull_m, kWrinkleReach_m, magnitude(eroded)) * -1.0f + 1.0f;
    const Jet<V> wrinkle = fins * patch * t.fin + noise(kHeadland) * t.headland + joints * t.joint;
    const Jet<V> raw = eroded + wrinkle * near * cliff;

    // Flanks that are steep already plunge into the sea without a wall of their own.
    const Jet<V> plunge = smoothstep(0.3f, 0.9f, Jet<V>{steep, zero, zero}) * -0.7f + 1.0f;
    const Jet<V> whole = noise(kCliffHeight) * t.cliff_vary + t.cliff;
    const auto low = hn::Lt(whole.v, hn::Set(d, 0.35f * t.cliff));
    const Jet<V> wall{hn::IfThenElse(low, hn::Set(d, 0.35f * t.cliff), whole.v), hn::IfThenZeroElse(low, whole.x),
                      hn::IfThenZeroElse(low, whole.z)};
    const Jet<V> lift = wall * cliff * plunge;
    const Jet<V> shelf = cliff * (t.shelf - 1.0f) + 1.0f;
    V stands;
    const Jet<V> remapped = cliff_remap(raw, lift, shelf, stands);

    // Waves heap sand where no cliff stands and the land behind is gentle.
    const V gentle = hn::Sub(one, smoothstep(0.08f, 0.22f, Jet<V>{steep, zero, zero}).v);
    const Jet<V> sandy = (cliff * -1.0f + 1.0f) * Jet<V>{hn::Mul(gentle, hn::Set(d, t.beach)), zero, zero};
    const Jet<V> out = remapped + beach_profile(raw) * sandy;
    const Jet<V> swash =
        smoothstep(2 * kBar_m, kBar_m, raw) * (smoothstep(kBerm_m, 2 * kDuneFoot_m, raw) * -1.0f + 1.0f);
    hn::StoreU(hn::Mul(sandy.v, swash.v), d, r.beach + i);
    hn::StoreU(out.v, d, r.height + i);
    hn::StoreU(out.x, d, r.slope_x + i);
    hn::StoreU(out.z, d, r.slope_z + i);
    hn::StoreU(stands, d, r.cliff + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(coast_row);

namespace {

/// Beyond these heights the stage changes nothing, so that its noises are not asked for.
bool is_far_from_sea(const ColumnGrid& grid, std::span<const float> height_m) {
  const std::size_t stride = row_stride(grid);
  float low = height_m[0];
  float high = height_m[0];
  for (std::size_t at = 0; at < sample_count(grid); at += stride) {
    const auto row = height_m.subspan(at, static_cast<std::size_t>(grid.width));
    const auto [row_low, row_high] = std::ranges::minmax(row);
    low = std::min(low, row_low);
    high = std::max(high, row_high);
  }
  return low > kCliffReach_m || high < -kShelfReach_m;
}

static_assert(kCoastArrays == kCoastNoises * 3);

std::array<FractalNoise, kCoastNoises> noises_of(const CoastControls& c) {
  const auto seed = [&](std::uint64_t use) { return mix64(c.seed, use); };
  const double fin_m = c.fin_wavelength_m;
  // Across the coast fins are three times as long as along it.
  return {{{c.district_m, 2, 2.3, 0.4, seed(0)},
           {700, 1, 2, 0.5, seed(1)},
           {3 * fin_m, 1, 2, 0.5, seed(2), 1.0 / 3},
           {fin_m, 1, 2, 0.5, seed(3), 3},
           {500, 1, 2, 0.5, seed(4)},
           {2.3 * fin_m, 1, 2, 0.5, seed(5)},
           {19, 1, 2, 0.5, seed(6)},
           {8, 1, 2, 0.5, seed(7)}}};
}

CoastTerms terms_of(const CoastControls& c) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(c.cliff_m),     f(c.cliff_vary_m), f(1.2 * (c.cliff_share - 0.5)),
          f(c.cliff_slope), f(c.fin_m),        f(0.7 * c.fin_m),
          f(c.joint_m),     f(c.shelf),        f(c.beach)};
}

}  // namespace

void coast(const CoastControls& c, const ColumnGrid& grid, const CoastInput& in, const CoastSurface& surface,
           std::span<float> workspace) {
  const std::size_t stride = row_stride(grid);
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(in.relief_x.size() >= count && in.relief_z.size() >= count && in.hilliness.size() >= count);
  TALUS_CHECK(surface.height_m.size() >= count && surface.slope_x.size() >= count && surface.slope_z.size() >= count);
  TALUS_CHECK(surface.cliff_m.size() >= count && surface.beach.size() >= count);
  TALUS_CHECK(workspace.size() >= kCoastArrays * count);
  std::fill_n(surface.cliff_m.begin(), count, 0.0f);
  std::fill_n(surface.beach.begin(), count, 0.0f);
  if (is_far_from_sea(grid, surface.height_m)) return;

  const auto noises = noises_of(c);
  CoastRow row{};
  for (std::size_t n = 0; n < kCoastNoises; ++n) {
    const auto array = [&](std::size_t part) { return workspace.subspan((n * 3 + part) * count, count); };
    fractal_noise(noises[n], grid, array(0), array(1), array(2));
    row.noise[n] = {array(0).data(), array(1).data(), array(2).data()};
  }
  const CoastTerms terms = terms_of(c);
  const auto run = HWY_DYNAMIC_DISPATCH(coast_row);
  for (std::size_t at = 0; at < count; at += stride) {
    CoastRow here = row;
    for (CoastNoise& n : here.noise) n = {n.v + at, n.x + at, n.z + at};
    here.relief_x = &in.relief_x[at];
    here.relief_z = &in.relief_z[at];
    here.hilliness = &in.hilliness[at];
    here.height = &surface.height_m[at];
    here.slope_x = &surface.slope_x[at];
    here.slope_z = &surface.slope_z[at];
    here.cliff = &surface.cliff_m[at];
    here.beach = &surface.beach[at];
    run(terms, here, static_cast<std::size_t>(grid.width));
  }
}

glm::dvec2 coast_bound(const CoastControls& c, glm::dvec2 heights_m) {
  const auto one = static_cast<double>(kNoiseScale);
  const double wrinkle = one * (1.7 * c.fin_m + 1.41 * c.joint_m) + 0.7;  // 0.7: most of a beach's profile
  const double lift = c.cliff_m + one * c.cliff_vary_m;
  // Heights keep their order, and beyond the reach of wrinkles and lift they stay what they are.
  const auto deepest = -static_cast<double>(kWrinkleReach_m);
  const auto reach = static_cast<double>(kCliffReach_m);
  const double low = heights_m.x > deepest ? std::max(deepest, heights_m.x - wrinkle) : heights_m.x;
  const double high = heights_m.y < reach ? std::min(reach, heights_m.y + wrinkle + lift) : heights_m.y;
  return {low, high};
}

}  // namespace talus
#endif  // HWY_ONCE
