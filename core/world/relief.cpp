#include "core/world/relief.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/world/relief.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = VecOf<D>>
HWY_INLINE Jet<V> load(D d, const NoiseArrays& a, std::size_t i) {
  return {hn::LoadU(d, a.v + i), hn::LoadU(d, a.x + i), hn::LoadU(d, a.z + i)};
}

void relief_row_target(const MacroTerms& t, const ReliefRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const auto constant = [&](float v) { return Jet<V>{hn::Set(d, v), hn::Zero(d), hn::Zero(d)}; };
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    // Land and sea: the continent noise through a shelf, so that coasts are gentle inland and steep seaward.
    const Jet<V> c = load(d, r.continent, i) + t.land_bias;
    const Jet<V> shelf = smoothstep(-0.55f, 0.05f, c);
    const Jet<V> inland = smoothstep(-0.05f, 0.65f, c);
    const Jet<V> swell = load(d, r.swell, i);
    const Jet<V> base = constant(t.sea_floor_m) + shelf * (-t.sea_floor_m - 6.0f) + inland * (t.plain_m + 6.0f) +
                        swell * (inland * 38.0f + 22.0f);

    // Ranges run along the zero line of their noise, where the massif noise allows, and sink towards the open sea.
    const Jet<V> line = load(d, r.range, i);
    const Jet<V> massif = smoothstep(-0.45f, 0.35f, load(d, r.massif, i));
    const Jet<V> ground = smoothstep(-0.30f, 0.25f, c);
    const Jet<V> allowed = massif * ground;
    const Jet<V> broad = bell(line, t.range_width) * allowed;
    const Jet<V> spine = bell(line, t.range_width * 0.42f) * allowed;
    const Jet<V> crest = load(d, r.crest, i) * 0.38f + 1.0f;
    const Jet<V> uplift = (broad * 0.62f + spine * 0.38f) * crest * t.range_height_m;

    // Hilliness: ranges fully, their forelands partly, plains hardly.
    const Jet<V> foot = smoothstep(-0.35f, 0.75f, swell) * ground * t.foothill;
    const Jet<V> hilliness = foot + (constant(1.0f) - foot) * smoothstep(0.0f, 0.55f, broad);

    const Jet<V> amplitude = hilliness * t.hill_high_m + t.hill_base_m;
    const Jet<V> hills = load(d, r.relief, i);
    const Jet<V> height = base + uplift + hills * (amplitude * (ground * 0.85f + 0.15f));

    // Where between valley and peak this point lies: -1 .. +1.
    const V valley = hn::Sub(base.v, hn::Mul(amplitude.v, hn::Set(d, 0.35f)));
    const V relief_m = hn::Add(hn::Set(d, t.range_height_m * 0.75f), hn::Mul(amplitude.v, hn::Set(d, 0.85f)));
    const V span = hn::Add(hn::Mul(relief_m, hn::Max(hilliness.v, hn::Set(d, 0.1f))), hn::Set(d, 60.0f));
    const V altitude = hn::Sub(hn::Mul(hn::Set(d, 2.0f), hn::Div(hn::Sub(height.v, valley), span)), hn::Set(d, 1.0f));
    const V clamped = hn::Min(hn::Max(altitude, hn::Set(d, -1.5f)), hn::Set(d, 1.5f));
    const V fade = hn::Add(hn::Mul(clamped, hn::Set(d, t.fade_altitude)), hn::Mul(hills.v, hn::Set(d, t.fade_relief)));

    // Strength: by hilliness, a little by altitude, and fading out under water.
    const V dry = smoothstep(-120.0f, -10.0f, height).v;
    const V high = smoothstep(60.0f, 300.0f, height).v;
    const V wear = hn::Add(hn::Add(hn::Set(d, t.plain_strength), hn::Mul(hilliness.v, hn::Set(d, t.hill_strength))),
                           hn::Mul(high, hn::Set(d, 0.12f)));
    hn::StoreU(height.v, d, r.height + i);
    hn::StoreU(height.x, d, r.slope_x + i);
    hn::StoreU(height.z, d, r.slope_z + i);
    hn::StoreU(fade, d, r.fade + i);
    hn::StoreU(hn::Mul(wear, dry), d, r.strength + i);
    hn::StoreU(hilliness.v, d, r.hilliness + i);
  }
}

void surface_row_target(const WorldFunction::Terms& t, const SurfaceRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto sum = [&](const float* a, const float* b, auto c) {
      return hn::Add(hn::Add(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), c);
    };
    const auto amplitude =
        hn::Add(hn::Set(d, t.micro_base_m), hn::Mul(hn::LoadU(d, r.hilliness + i), hn::Set(d, t.micro_high_m)));
    const auto rough = [&](const float* a) { return hn::Mul(hn::LoadU(d, a + i), amplitude); };
    const auto height = sum(r.height, r.eroded, rough(r.micro));
    hn::StoreU(hn::Min(hn::Max(height, hn::Set(d, t.low_m)), hn::Set(d, t.high_m)), d, r.out_height + i);
    const auto slope_x = sum(r.slope_x, r.eroded_x, rough(r.micro_x));
    const auto slope_z = sum(r.slope_z, r.eroded_z, rough(r.micro_z));
    hn::StoreU(slope_x, d, r.out_slope_x + i);
    hn::StoreU(slope_z, d, r.out_slope_z + i);
    const auto one = hn::Set(d, 1.0f);
    const auto square = hn::Add(hn::Mul(slope_x, slope_x), hn::Mul(slope_z, slope_z));
    hn::StoreU(hn::Div(one, hn::Sqrt(hn::Add(one, square))), d, r.out_steepness + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(relief_row_target);
HWY_EXPORT(surface_row_target);

void relief_row(const MacroTerms& macro, const ReliefRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(relief_row_target)(macro, row, width);
}

void surface_row(const WorldFunction::Terms& terms, const SurfaceRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(surface_row_target)(terms, row, width);
}

}  // namespace talus
#endif  // HWY_ONCE
