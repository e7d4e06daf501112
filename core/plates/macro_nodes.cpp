#include "core/plates/macro_nodes.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plates/macro_nodes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"
#include "core/plates/fault_profile-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Distances from a fault at which its curve is the whole one, its first octave, and straight; in metres at full width.
/// Without this every wiggle is drawn out over the whole profile: feathers along ranges, zigzags in rifts.
inline constexpr float kBroadFrom_m = 2200.0f;
inline constexpr float kStraightFrom_m = 8000.0f;
/// The inverse distance stays finite within this, in metres.
inline constexpr float kNear_m = 700.0f;
/// Share of a fault at either end over which its crest passes to the vertex's.
inline constexpr float kEase = 0.42f;

using D = hn::CappedTag<float, kGroupNodes>;
using V = hn::Vec<D>;
using J = Jet<V>;

HWY_INLINE J loaded(D d, const GroupJet& a, std::size_t i) {
  return {hn::Load(d, &a.v[i]), hn::Load(d, &a.x[i]), hn::Load(d, &a.z[i])};
}
HWY_INLINE void stored(D d, const J& a, GroupJet& to, std::size_t i) {
  hn::Store(a.v, d, &to.v[i]);
  hn::Store(a.x, d, &to.x[i]);
  hn::Store(a.z, d, &to.z[i]);
}

/// A curve's displacement where the fault's coordinate along is `u`, with its slope. Constant 0 beyond both ends.
HWY_INLINE J curve_jet(D d, const PlateFault& fault, const float* curve, const J& u) {
  const hn::RebindToSigned<D> di;
  const float samples = static_cast<float>(fault.curve.samples);
  const float per_metre = samples / fault.length_m;
  const V position = hn::Min(hn::Max(hn::Mul(u.v, hn::Set(d, per_metre)), hn::Zero(d)), hn::Set(d, samples));
  const V whole = hn::Floor(position);
  const V f = hn::Sub(position, whole);
  const auto at = hn::ConvertTo(di, whole);
  const V before = hn::GatherIndex(d, curve, at);
  const V from = hn::GatherIndex(d, curve + 1, at);
  const V to = hn::GatherIndex(d, curve + 2, at);
  const V after = hn::GatherIndex(d, curve + 3, at);
  const V half = hn::Set(d, 0.5f);
  const V m0 = hn::Mul(half, hn::Sub(to, before));
  const V m1 = hn::Mul(half, hn::Sub(after, from));
  const V rise = hn::Sub(to, from);
  const V c2 = hn::Sub(hn::Sub(hn::Mul(rise, hn::Set(d, 3.0f)), hn::Add(m0, m0)), m1);
  const V c3 = hn::Sub(hn::Add(m0, m1), hn::Add(rise, rise));
  const V value = hn::Add(from, hn::Mul(f, hn::Add(m0, hn::Mul(f, hn::Add(c2, hn::Mul(f, c3))))));
  const V slope = hn::Add(m0, hn::Mul(f, hn::Add(hn::Add(c2, c2), hn::Mul(f, hn::Mul(c3, hn::Set(d, 3.0f))))));
  return chained(u, value, hn::Mul(slope, hn::Set(d, per_metre)));
}

/// Signed distance to the curve, positive on the front plate. Its zero is the curve itself; farther away it forgets the
/// curve's wiggles.
HWY_INLINE J fault_distance(D d, const PlateFault& fault, const float* curves, const J& u, const J& y) {
  const J full = curve_jet(d, fault, curves + fault.curve.full, u);
  const J broad = curve_jet(d, fault, curves + fault.curve.broad, u);
  const float scale = std::min(1.0f, fault.features.scale);
  const J away = abs(y - full);
  const J near = mix(full, broad, smoothstep(0.0f, kBroadFrom_m * scale, away));
  return y - near * falling(0.0f, kStraightFrom_m * scale, away);
}

/// weight / (distance to the fault's segment^2 + kNear^2)^1.5.
HWY_INLINE J weight_of(D d, const PlateFault& fault, const J& u, const J& v) {
  const V beyond = hn::Sub(u.v, hn::Set(d, fault.length_m));
  const V end = hn::Sub(hn::Max(beyond, hn::Zero(d)), hn::Max(hn::Neg(u.v), hn::Zero(d)));
  const J outside = chained(u, end, hn::IfThenElseZero(hn::Ne(end, hn::Zero(d)), hn::Set(d, 1.0f)));
  // In kilometres: the cube of a distance would leave the floats that stay exact under division.
  const J square = (outside * outside + v * v) * 1e-6f + kNear_m * kNear_m * 1e-6f;
  const V root = hn::Sqrt(square.v);
  const V value = hn::Div(hn::Set(d, fault.weight), hn::Mul(square.v, root));
  return chained(square, value, hn::Div(hn::Mul(value, hn::Set(d, -1.5f)), square.v));
}

/// From `start` over `whole` to `end` along the fault.
HWY_INLINE J eased(float start, float whole, float end, const J& at_start, const J& at_end) {
  // start (1 - a) + end (1 - b) + whole (a + b - 1).
  return at_start * (whole - start) + at_end * (whole - end) + (start + end - whole);
}

struct FaultValues {
  J weight, inside;
  std::array<J, kMacroChannels> channel;
};

HWY_INLINE FaultValues fault_values(D d, const PlateFault& fault, const float* curves, const ShelfTerms& coast, V x,
                                    V z) {
  const J from_x{hn::Sub(x, hn::Set(d, fault.start_x)), hn::Set(d, 1.0f), hn::Zero(d)};
  const J from_z{hn::Sub(z, hn::Set(d, fault.start_z)), hn::Zero(d), hn::Set(d, 1.0f)};
  const J u = from_x * fault.along_x + from_z * fault.along_z;
  const J y = from_x * fault.across_x + from_z * fault.across_z;
  const J v = fault_distance(d, fault, curves, u, y);

  FaultValues out;
  out.weight = weight_of(d, fault, u, v);
  const float per_blend = fault.side / fault.blend_m;
  const V share = logistic(d, hn::Mul(v.v, hn::Set(d, per_blend)));
  const V share_slope = hn::Mul(hn::Mul(share, hn::Sub(hn::Set(d, 1.0f), share)), hn::Set(d, per_blend));
  out.inside = chained(v, share, share_slope);

  const FaultFeatures& f = fault.features;
  const J s = v * (1.0f / f.scale);
  const FaultShape<V> shape = shape_of(f.kind, s);
  const J at_start = smoothstep(0.0f, kEase * fault.length_m, u);
  const J at_end = smoothstep(0.0f, kEase * fault.length_m, constant_jet<V>(fault.length_m) - u);
  const J crest = eased(fault.start_crest_m, f.crest_m, fault.end_crest_m, at_start, at_end);
  const J trench = eased(0.5f * f.trench_m, f.trench_m, 0.5f * f.trench_m, at_start, at_end);
  const J uplift = crest * shape.uplift;
  const bool is_arc = f.kind == FaultClass::kIslandArc;
  out.channel[kBase] = base_of(fault, coast, s) - trench * shape.trench;
  out.channel[kUplift] = is_arc ? constant_jet<V>(0.0f) : uplift;
  out.channel[kArc] = is_arc ? uplift : constant_jet<V>(0.0f);
  out.channel[kCrest] = crest;
  out.channel[kHilly] =
      shape.hilliness * eased(fault.start_hilliness, f.hilliness, fault.end_hilliness, at_start, at_end);
  return out;
}

void add_plate_target(const PlacedPlate& placed, const ShelfTerms& coast, const NodeGroup& group, GroupSums& sums) {
  const D d;
  const Plate& plate = *placed.plate;
  for (std::size_t i = 0; i < kGroupNodes; i += hn::Lanes(d)) {
    J share = constant_jet<V>(1.0f);
    J weight = constant_jet<V>(0.0f);
    std::array<J, kMacroChannels> mean;
    for (J& m : mean) m = constant_jet<V>(0.0f);
    for (const PlateFault& fault : plate.faults) {
      const glm::i64vec2 front = placed.site_from_origin + fault.front_from_site;
      const V x = hn::Sub(hn::Load(d, &group.x[i]), hn::Set(d, static_cast<float>(front.x)));
      const V z = hn::Sub(hn::Load(d, &group.z[i]), hn::Set(d, static_cast<float>(front.y)));
      const FaultValues values = fault_values(d, fault, plate.curves.data(), coast, x, z);
      share = share * values.inside;
      // No share grows again: cutting it early only keeps it out of the denormals.
      const auto has_share = hn::Gt(share.v, hn::Set(d, kShareMin));
      share = {hn::IfThenElseZero(has_share, share.v), hn::IfThenElseZero(has_share, share.x),
               hn::IfThenElseZero(has_share, share.z)};
      weight = weight + values.weight;
      for (std::size_t c = 0; c < kMacroChannels; ++c) mean[c] = mean[c] + values.channel[c] * values.weight;
    }
    const auto has_share = hn::Gt(share.v, hn::Set(d, kShareMin));
    share.v = hn::IfThenElseZero(has_share, hn::Sub(share.v, hn::Set(d, kShareMin)));
    stored(d, loaded(d, sums.share, i) + share, sums.share, i);
    const V one_by = hn::Div(hn::Set(d, 1.0f), weight.v);
    const J inverse = chained(weight, one_by, hn::Neg(hn::Mul(one_by, one_by)));
    const J part = share * inverse;
    for (std::size_t c = 0; c < kMacroChannels; ++c)
      stored(d, loaded(d, sums.channel[c], i) + mean[c] * part, sums.channel[c], i);
  }
}

void finish_group_target(GroupSums& sums) {
  const D d;
  for (std::size_t i = 0; i < kGroupNodes; i += hn::Lanes(d)) {
    const J share = loaded(d, sums.share, i);
    const V one_by = hn::Div(hn::Set(d, 1.0f), share.v);
    const J inverse = chained(share, one_by, hn::Neg(hn::Mul(one_by, one_by)));
    for (GroupJet& channel : sums.channel) stored(d, loaded(d, channel, i) * inverse, channel, i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(add_plate_target);
HWY_EXPORT(finish_group_target);

bool can_share(const PlacedPlate& placed, const glm::dvec2& low, const glm::dvec2& high) {
  for (const PlateFault& fault : placed.plate->faults) {
    const glm::dvec2 start = glm::dvec2(placed.site_from_origin + fault.front_from_site) +
                             glm::dvec2{static_cast<double>(fault.start_x), static_cast<double>(fault.start_z)};
    const auto side = static_cast<double>(fault.side);
    const double nx = side * static_cast<double>(fault.across_x);
    const double nz = side * static_cast<double>(fault.across_z);
    const double deepest = nx * ((nx > 0 ? high.x : low.x) - start.x) + nz * ((nz > 0 ? high.y : low.y) - start.y);
    // A metre for what floats round.
    if (deepest < -static_cast<double>(kShareReach * fault.blend_m + fault.reach_m) - 1) return false;
  }
  return true;
}

void add_plate(const PlacedPlate& placed, const ShelfTerms& coast, const NodeGroup& group, GroupSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_plate_target)(placed, coast, group, sums);
}

void finish_group(GroupSums& sums) {
  HWY_DYNAMIC_DISPATCH(finish_group_target)(sums);
}

}  // namespace talus
#endif  // HWY_ONCE
