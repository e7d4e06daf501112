#include "core/plates/fault.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"

namespace talus {
namespace {

/// Closing speed from which a fault is more than at rest, and what it takes from there to full strength.
constexpr double kRestSpeed = 0.3;
constexpr double kFullSpeed = 0.7;
/// Island arcs rise over their trench whatever the speed; so do the others, by these shares of the full height.
constexpr double kCollisionBase = 0.38;
constexpr double kSubductionBase = 0.33;
constexpr double kArcBase = 0.54;
constexpr double kRidgeBase = 0.52;
constexpr double kRiftBase = 0.53;
constexpr double kTrenchBase = 0.45;

double grown(double base, double strength) {
  return base + (1 - base) * strength;
}

/// 0..1, one for each pair of plates.
double pair_chance(const PlateControls& plates, const SiteKey& a, const SiteKey& b) {
  const auto& [first, second] = std::minmax(a, b);
  const SiteKey low = first_turn(plates, first);
  const SiteKey high = first_turn(plates, second);
  std::uint64_t hash = mix64(plates.seed, 0xFA017);
  for (const std::int64_t v : {low.x, low.z, high.x, high.z}) hash = mix64(hash, static_cast<std::uint64_t>(v));
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

bool is_land(const PlateSeat& seat) {
  return seat.traits.kind == PlateKind::kContinental;
}

FaultClass class_of(bool front_land, bool back_land, double closing) {
  if (front_land != back_land) return closing > kRestSpeed ? FaultClass::kSubduction : FaultClass::kPassive;
  if (closing > kRestSpeed) return front_land ? FaultClass::kCollision : FaultClass::kIslandArc;
  if (closing < -kRestSpeed) return front_land ? FaultClass::kRift : FaultClass::kOceanRidge;
  return front_land ? FaultClass::kOldLand : FaultClass::kOldSea;
}

}  // namespace

bool is_front(const PlateSeat& a, const PlateSeat& b) {
  if (is_land(a) != is_land(b)) return is_land(a);
  // The older sea floor is the heavier one: it dives, and the arc stands on the younger.
  if (a.traits.age != b.traits.age) return a.traits.age < b.traits.age;
  return a.site.key < b.site.key;
}

FaultFeatures features_of(const PlateControls& plates, const MacroControls& macro, const PlateSeat& front,
                          const PlateSeat& back) {
  const glm::i64vec2 apart_m = front.site.at_m - back.site.at_m;
  const auto x = static_cast<double>(apart_m.x);
  const auto z = static_cast<double>(apart_m.y);
  const double distance_m = std::sqrt(x * x + z * z);
  const glm::vec2 towards = back.traits.velocity - front.traits.velocity;
  const double closing = (static_cast<double>(towards.x) * x + static_cast<double>(towards.y) * z) / distance_m;
  const double strength = std::clamp((std::abs(closing) - kRestSpeed) / kFullSpeed, 0.0, 1.0);
  const double scale = std::min(1.0, 0.5 * distance_m / kFullWidth_m);
  const double chance = pair_chance(plates, front.site.key, back.site.key);

  FaultFeatures f;
  f.kind = class_of(is_land(front), is_land(back), closing);
  double crest_m = 0;
  double trench_m = 0;
  double hilliness = 0;
  switch (f.kind) {
    case FaultClass::kCollision:
      crest_m = macro.collision_m * grown(kCollisionBase, strength);
      hilliness = 0.7 + 0.3 * strength;
      break;
    case FaultClass::kSubduction:
      crest_m = macro.subduction_m * grown(kSubductionBase, strength);
      trench_m = macro.trench_m * grown(kTrenchBase, strength);
      hilliness = 0.5 + 0.5 * strength;
      break;
    case FaultClass::kIslandArc:
      crest_m = macro.arc_m * grown(kArcBase, strength);
      trench_m = macro.trench_m * grown(kTrenchBase, strength);
      hilliness = 0.45;
      break;
    case FaultClass::kOceanRidge:
      crest_m = macro.ocean_ridge_m * grown(kRidgeBase, strength);
      hilliness = 0.12;
      break;
    case FaultClass::kRift:
      crest_m = macro.rift_m * grown(kRiftBase, strength);
      hilliness = 0.3;
      break;
    case FaultClass::kOldLand:
      // The square leaves most faults blank: a constant ridge would draw the web of plates on the map.
      crest_m = macro.old_fault_m * (0.06 + 0.94 * chance * chance);
      hilliness = 0.04 + 0.34 * chance * chance;
      break;
    case FaultClass::kOldSea:
      crest_m = 0.12 * macro.old_fault_m;
      hilliness = 0.05;
      break;
    case FaultClass::kPassive:
      hilliness = 0.12;
      break;
  }
  // Heights shrink slower than widths, or small plates would be flat; faster than not at all, or they would be walls.
  const double lower = std::sqrt(scale);
  f.scale = static_cast<float>(scale * macro.range_width);
  f.crest_m = static_cast<float>(crest_m * lower);
  f.trench_m = static_cast<float>(trench_m * lower);
  f.hilliness = static_cast<float>(hilliness);
  return f;
}

}  // namespace talus
