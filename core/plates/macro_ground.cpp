#include "core/plates/macro_ground.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plates/macro_ground.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void ground_row_target(const MacroControls& m, const GroundRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  using J = Jet<V>;
  const auto real = [](double v) { return static_cast<float>(v); };
  const auto load = [&](const NodeArrays& a, std::size_t i) {
    return J{hn::LoadU(d, a.v + i), hn::LoadU(d, a.x + i), hn::LoadU(d, a.z + i)};
  };
  // + 0 makes one zero of the two, so that interpolation with weight 0 changes no bit.
  const auto store = [&](const J& j, const NodeArrays& a, std::size_t i) {
    hn::StoreU(hn::Add(j.v, hn::Zero(d)), d, a.v + i);
    hn::StoreU(hn::Add(j.x, hn::Zero(d)), d, a.x + i);
    hn::StoreU(hn::Add(j.z, hn::Zero(d)), d, a.z + i);
  };
  const auto select = [](auto mask, const J& a, const J& b) {
    return J{hn::IfThenElse(mask, a.v, b.v), hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.z, b.z)};
  };
  const J one{hn::Set(d, 1.0f), hn::Zero(d), hn::Zero(d)};
  const float unevenness = real(m.uplift_noise);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const J base = load(r.channel[kBase], i);
    // Ranges rise unevenly, and a valley cuts through them wherever its noise crosses 0: a pass.
    const J uneven = smoothstep(-0.75f, 0.75f, load(r.noise[kUpliftNoise], i)) * (2 * unevenness) + (1 - unevenness);
    const J valley = bell(load(r.noise[kPassNoise], i), 0.2f) * real(m.pass_depth);
    const J islands = smoothstep(-0.35f, 0.4f, load(r.noise[kArcNoise], i)) * 0.85f + 0.4f;
    const J uplift = load(r.channel[kUplift], i) * uneven * (one - valley) + load(r.channel[kArc], i) * islands;

    const J inland = smoothstep(-150.0f, 60.0f, base);
    const J swell = load(r.noise[kSwellNoise], i) * real(m.swell_m) * (inland * 0.75f + 0.25f);
    const J shore = smoothstep(-330.0f, -120.0f, base) * (one - smoothstep(150.0f, 500.0f, base) * 0.6f);
    const J coast = load(r.noise[kCoastNoise], i) * real(m.coast_m) * shore;

    const J floor = base + swell + coast;
    const J crest = load(r.channel[kCrest], i) * 0.55f;
    store(floor + uplift, r.channel[kUplift], i);
    store(select(hn::Gt(uplift.v, crest.v), uplift, crest), r.channel[kCrest], i);
    store(floor, r.channel[kBase], i);
    store(load(r.channel[kHilly], i), r.channel[kHilly], i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(ground_row_target);

void ground_row(const MacroControls& macro, const GroundRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(ground_row_target)(macro, row, width);
}

}  // namespace talus
#endif  // HWY_ONCE
