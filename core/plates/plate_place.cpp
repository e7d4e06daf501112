#include "core/plates/plate_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/plates/fault_curve.hpp"

namespace talus {
namespace {

/// Squares around a point's own that hold its nearest site: kSiteReach is little more than one square.
constexpr std::int64_t kNearestSquares = 2;

double length2(const glm::dvec2& v) {
  return v.x * v.x + v.y * v.y;
}

/// The nearest site; of several the one that is first by its key.
Site nearest_site(const PlateSites& sites, const glm::i64vec2& whole_m, const glm::dvec2& rest_m) {
  std::vector<Site> found;
  const std::int64_t x = sites.square_of(whole_m.x);
  const std::int64_t z = sites.square_of(whole_m.y);
  for (std::int64_t dz = -kNearestSquares; dz <= kNearestSquares; ++dz) {
    for (std::int64_t dx = -kNearestSquares; dx <= kNearestSquares; ++dx) sites.add_sites(x + dx, z + dz, found);
  }
  const auto distance2 = [&](const Site& s) { return length2(glm::dvec2(s.at_m - whole_m) - rest_m); };
  return *std::ranges::min_element(found, [&](const Site& a, const Site& b) {
    const double to_a = distance2(a);
    const double to_b = distance2(b);
    return to_a != to_b ? to_a < to_b : a.key < b.key;
  });
}

/// A point in the frame of a fault.
struct AtFault {
  double t = 0;      ///< along, 0..1 between the vertices
  double y = 0;      ///< from the straight line, positive towards the front site
  double curve = 0;  ///< displacement of the fault at t
};

AtFault at_fault(const Plate& plate, const PlateFault& fault, const glm::dvec2& from_site_m) {
  const glm::dvec2 from_start = from_site_m - glm::dvec2(fault.front_from_site) -
                                glm::dvec2{static_cast<double>(fault.start_x), static_cast<double>(fault.start_z)};
  AtFault out;
  const double u =
      from_start.x * static_cast<double>(fault.along_x) + from_start.y * static_cast<double>(fault.along_z);
  out.t = u / static_cast<double>(fault.length_m);
  out.y = from_start.x * static_cast<double>(fault.across_x) + from_start.y * static_cast<double>(fault.across_z);
  out.curve = static_cast<double>(
      curve_at(&plate.curves[fault.curve.full], fault.curve.samples, static_cast<float>(std::clamp(out.t, 0.0, 1.0))));
  return out;
}

/// Whether the way from the plate's site to the point leads through the fault's straight line.
bool is_behind(const PlateFault& fault, const glm::dvec2& from_site_m) {
  const glm::dvec2 start = glm::dvec2(fault.front_from_site) +
                           glm::dvec2{static_cast<double>(fault.start_x), static_cast<double>(fault.start_z)};
  const glm::dvec2 end = start + glm::dvec2{static_cast<double>(fault.along_x), static_cast<double>(fault.along_z)} *
                                     static_cast<double>(fault.length_m);
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const double turn = cross(start, end) < 0 ? -1.0 : 1.0;
  return turn * cross(start, from_site_m) >= 0 && turn * cross(from_site_m, end) >= 0;
}

SiteKey other_side(const PlateFault& fault) {
  return fault.side > 0 ? fault.back : fault.front;
}

}  // namespace

PlatePlace place_at(const PlateBuilder& plates, const glm::dvec2& place_m, PlateMemo& memo) {
  const glm::i64vec2 whole_m{static_cast<std::int64_t>(std::floor(place_m.x)),
                             static_cast<std::int64_t>(std::floor(place_m.y))};
  const glm::dvec2 rest_m = place_m - glm::dvec2(whole_m);
  Site owner = nearest_site(plates.sites(), whole_m, rest_m);
  const auto from = [&](const Site& site) { return glm::dvec2(whole_m - site.at_m) + rest_m; };
  const Plate* plate = &memo.load(plates, owner.key);
  for (const PlateFault& fault : plate->faults) {
    if (!is_behind(fault, from(owner))) continue;
    const AtFault here = at_fault(*plate, fault, from(owner));
    const bool is_past = fault.side > 0 ? here.y < here.curve : here.y >= here.curve;
    if (is_past && here.t > 0 && here.t < 1) owner = plates.sites().site(other_side(fault));
    break;
  }

  plate = &memo.load(plates, owner.key);
  PlatePlace out;
  out.plate = owner;
  out.traits = plate->seat.traits;
  double nearest = 1e300;
  for (const PlateFault& fault : plate->faults) {
    const AtFault here = at_fault(*plate, fault, from(owner));
    const double beyond = std::max({0.0, -here.t, here.t - 1}) * static_cast<double>(fault.length_m);
    const double away = here.y - here.curve;
    const double distance2 = beyond * beyond + away * away;
    if (distance2 >= nearest) continue;
    nearest = distance2;
    out.neighbour.key = other_side(fault);
    out.fault = fault.features.kind;
    out.is_front = fault.side > 0;
    out.fault_m = static_cast<float>(std::sqrt(distance2)) * fault.side;
  }
  out.neighbour = plates.sites().site(out.neighbour.key);
  return out;
}

}  // namespace talus
