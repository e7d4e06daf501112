#include "core/plates/plate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/hash.hpp"
#include "core/plates/fault_curve.hpp"
#include "core/plates/plate_polygon.hpp"

namespace talus {
namespace {

/// A side shorter than this is no fault: where four sites lie almost on a circle rounding decides whether it is there.
constexpr double kFaultLengthMin_m = 1.0;
/// Length from which a fault weighs fully among its plate's.
constexpr double kFullWeight_m = 5000;
constexpr double kWeightMin = 0.02;
/// The two highest crests at a vertex make its common one: the mean of all three makes strings of beads, this keeps
/// ranges unbroken and throws spurs into weaker faults.
constexpr float kVertexShare = 0.92f;

float real(double v) {
  return static_cast<float>(v);
}

double smoothstep(double low, double high, double v) {
  const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

float vertex_value(float a, float b, float c) {
  const float smallest = std::min({a, b, c});
  return kVertexShare * 0.5f * (a + b + c - smallest);
}

/// What a fault gives to the crest at its vertex: a rift lowers the ground there.
float vertex_crest(const FaultFeatures& features) {
  return features.kind == FaultClass::kRift ? 0.0f : features.crest_m;
}

/// The frame, the curve's place among the plate's, and the features of the fault towards one neighbour.
class FaultMaker {
 public:
  FaultMaker(const PlateControls& plates, const MacroControls& macro, const PlateSeat& seat)
      : plates_(plates), macro_(macro), seat_(seat) {}

  FaultFeatures features(const PlateSeat& a, const PlateSeat& b) const {
    return is_front(a, b) ? features_of(plates_, macro_, a, b) : features_of(plates_, macro_, b, a);
  }

  /// `before` and `after` are the neighbours on either side of `other` around the plate. False if there is no fault.
  bool make(const PlateSeat& before, const PlateSeat& other, const PlateSeat& after, PlateFault& out) const {
    const bool is_mine = is_front(seat_, other);
    const PlateSeat& front = is_mine ? seat_ : other;
    const PlateSeat& back = is_mine ? other : seat_;
    out.front = front.site.key;
    out.back = back.site.key;
    out.front_from_site = front.site.at_m - seat_.site.at_m;
    out.side = is_mine ? 1.0f : -1.0f;

    const glm::i64vec2 towards = front.site.at_m - back.site.at_m;
    const glm::dvec2 apart{static_cast<double>(towards.x), static_cast<double>(towards.y)};
    const double distance_m = std::sqrt(apart.x * apart.x + apart.y * apart.y);
    const glm::dvec2 across = apart / distance_m;
    const glm::dvec2 along{-across.y, across.x};
    const glm::dvec2 a = vertex_of(seat_.site, other.site, before.site, front.site.at_m);
    const glm::dvec2 b = vertex_of(seat_.site, other.site, after.site, front.site.at_m);
    const double u_a = a.x * along.x + a.y * along.y;
    const double u_b = b.x * along.x + b.y * along.y;
    const bool is_turned = u_b < u_a;
    const glm::dvec2& start = is_turned ? b : a;
    const double u_start = is_turned ? u_b : u_a;
    const double length_m = is_turned ? u_a - u_b : u_b - u_a;
    if (length_m < kFaultLengthMin_m) return false;

    out.start_x = real(start.x);
    out.start_z = real(start.y);
    out.along_x = real(along.x);
    out.along_z = real(along.y);
    out.across_x = real(across.x);
    out.across_z = real(across.y);
    out.length_m = real(length_m);
    out.foot_t = real(-u_start / length_m);
    out.half_m = real(0.5 * distance_m);
    out.features = features(front, back);
    out.front_m = front.traits.elevation_m;
    out.back_m = back.traits.elevation_m;
    out.blend_m = real(plates_.blend_m * std::min(1.0, 0.5 * distance_m / kFullWidth_m));
    out.weight = real(kWeightMin + smoothstep(0, kFullWeight_m, length_m));
    ease(is_turned ? after : before, front, back, out.start_crest_m, out.start_hilliness, out.features);
    ease(is_turned ? before : after, front, back, out.end_crest_m, out.end_hilliness, out.features);
    return true;
  }

 private:
  void ease(const PlateSeat& third, const PlateSeat& front, const PlateSeat& back, float& crest_m, float& hilliness,
            const FaultFeatures& own) const {
    const FaultFeatures x = features(front, third);
    const FaultFeatures y = features(back, third);
    crest_m = vertex_value(vertex_crest(own), vertex_crest(x), vertex_crest(y));
    // A rift between mountains would be as deep as they are high.
    if (own.kind == FaultClass::kRift) crest_m = std::min(crest_m, own.crest_m);
    hilliness = vertex_value(own.hilliness, x.hilliness, y.hilliness);
  }

  const PlateControls& plates_;
  const MacroControls& macro_;
  const PlateSeat& seat_;
};

void add_curve(const PlateControls& controls, PlateFault& fault, std::vector<float>& curves) {
  fault.curve.samples = curve_samples(static_cast<double>(fault.length_m));
  const std::size_t count = curve_floats(fault.curve.samples);
  fault.curve.full = curves.size();
  fault.curve.broad = curves.size() + count;
  curves.resize(curves.size() + 2 * count);
  std::uint64_t seed = mix64(controls.seed, 0xC0A57);
  const SiteKey front = first_turn(controls, fault.front);
  const SiteKey back = first_turn(controls, fault.back);
  for (const std::int64_t v : {front.x, front.z, back.x, back.z}) seed = mix64(seed, static_cast<std::uint64_t>(v));
  float* full = &curves[fault.curve.full];
  float* broad = &curves[fault.curve.broad];
  fault_curve({fault.curve.samples, fault.length_m, fault.foot_t, fault.half_m, real(controls.wiggle),
               real(controls.wiggle_m), seed},
              full, broad);
  float reach_m = 0;
  for (std::size_t i = 0; i < 2 * count; ++i) reach_m = std::max(reach_m, std::abs(full[i]));
  fault.reach_m = kCubicOvershoot * reach_m;
}

std::uint64_t fingerprint_of(const PlateControls& p, const MacroControls& m) {
  std::uint64_t hash = mix64(mix64(p.seed, m.seed), static_cast<std::uint64_t>(p.wrap_m));
  for (const double v : {p.size_m,        p.jitter,      p.big_share,   p.cluster_m,   p.scatter,      p.ocean,
                         p.group_speed,   p.own_speed,   p.wiggle,      p.wiggle_m,    p.blend_m,      m.land_m,
                         m.land_range_m,  m.sea_floor_m, m.sea_range_m, m.collision_m, m.subduction_m, m.arc_m,
                         m.ocean_ridge_m, m.rift_m,      m.old_fault_m, m.trench_m,    m.range_width})
    hash = mix64(hash, std::bit_cast<std::uint64_t>(v));
  return hash;
}

}  // namespace

PlateBuilder::PlateBuilder(const PlateControls& plates, const MacroControls& macro)
    : plates_(plates), macro_(macro), sites_(plates, macro), fingerprint_(fingerprint_of(plates, macro)) {}

void PlateBuilder::build(const SiteKey& key, Plate& out) const {
  const Site site = sites_.site(key);
  out.seat = {site, sites_.traits(site)};
  out.faults.clear();
  out.curves.clear();
  std::vector<PlateSeat> neighbours;
  for (const PolygonSide& side : polygon_of(sites_, site))
    neighbours.push_back({side.neighbour, sites_.traits(side.neighbour)});
  const FaultMaker maker(plates_, macro_, out.seat);
  const std::size_t count = neighbours.size();
  for (std::size_t i = 0; i < count; ++i) {
    PlateFault fault;
    if (!maker.make(neighbours[(i + count - 1) % count], neighbours[i], neighbours[(i + 1) % count], fault)) continue;
    add_curve(plates_, fault, out.curves);
    out.faults.push_back(fault);
  }
}

}  // namespace talus
