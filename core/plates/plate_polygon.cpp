#include "core/plates/plate_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.hpp"

namespace talus {
namespace {

constexpr std::int64_t kRingMax = 3;

double square(double v) {
  return v * v;
}

struct Candidate {
  Site site;
  double distance2;
};

/// Sites of the squares exactly `ring` squares away from the one at `centre`, nearest to `site` first.
std::vector<Candidate> sites_of_ring(const PlateSites& sites, const Site& site, const glm::i64vec2& centre,
                                     std::int64_t ring) {
  std::vector<Site> found;
  for (std::int64_t dz = -ring; dz <= ring; ++dz) {
    for (std::int64_t dx = -ring; dx <= ring; ++dx) {
      const bool is_new = ring <= 1 || std::max(std::abs(dx), std::abs(dz)) == ring;
      if (is_new) sites.add_sites(centre.x + dx, centre.y + dz, found);
    }
  }
  std::vector<Candidate> out;
  out.reserve(found.size());
  for (const Site& other : found) {
    if (other.key == site.key) continue;
    const glm::i64vec2 away = other.at_m - site.at_m;
    out.push_back({other, square(static_cast<double>(away.x)) + square(static_cast<double>(away.y))});
  }
  std::ranges::sort(out, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.distance2, a.site.key) < std::pair(b.distance2, b.site.key);
  });
  return out;
}

/// Cuts off what is nearer to `other` than to `site`.
void clip(const Site& site, const Site& other, std::vector<PolygonSide>& polygon, std::vector<PolygonSide>& memory) {
  const glm::i64vec2 away = other.at_m - site.at_m;
  const double x = static_cast<double>(away.x);
  const double z = static_cast<double>(away.y);
  const double limit = 0.5 * (x * x + z * z);
  const auto beyond = [&](const glm::dvec2& p) { return p.x * x + p.y * z - limit; };
  memory.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PolygonSide& here = polygon[i];
    const PolygonSide& next = polygon[(i + 1) % polygon.size()];
    const double from = beyond(here.start_m);
    const double to = beyond(next.start_m);
    const auto crossing = [&] {
      const double t = from / (from - to);
      return here.start_m + (next.start_m - here.start_m) * t;
    };
    if (from <= 0) {
      memory.push_back(here);
      if (to > 0) memory.push_back({other, crossing()});
    } else if (to <= 0) {
      memory.push_back({here.neighbour, crossing()});
    }
  }
  std::swap(polygon, memory);
}

double farthest_corner2(const std::vector<PolygonSide>& polygon) {
  double out = 0;
  for (const PolygonSide& side : polygon) out = std::max(out, square(side.start_m.x) + square(side.start_m.y));
  return out;
}

}  // namespace

std::vector<PolygonSide> polygon_of(const PlateSites& sites, const Site& site) {
  const double square_m = static_cast<double>(sites.square_m());
  const glm::i64vec2 centre{sites.square_of(site.at_m.x), sites.square_of(site.at_m.y)};
  const double far = 2 * square_m;
  std::vector<PolygonSide> polygon{{site, {-far, -far}}, {site, {far, -far}}, {site, {far, far}}, {site, {-far, far}}};
  std::vector<PolygonSide> memory;
  for (std::int64_t ring = 1; ring <= kRingMax; ++ring) {
    double reach2 = 4 * farthest_corner2(polygon);
    for (const Candidate& candidate : sites_of_ring(sites, site, centre, ring)) {
      if (candidate.distance2 > reach2) break;
      clip(site, candidate.site, polygon, memory);
      reach2 = 4 * farthest_corner2(polygon);
    }
    // The site lies inside the centre square, so all sites beyond this ring are at least `ring` squares away.
    if (reach2 < square(static_cast<double>(ring) * square_m)) break;
  }
  TALUS_CHECK(std::ranges::none_of(polygon, [&](const PolygonSide& s) { return s.neighbour.key == site.key; }));
  return polygon;
}

glm::dvec2 vertex_of(Site a, Site b, Site c, const glm::i64vec2& origin_m) {
  if (b.key < a.key) std::swap(a, b);
  if (c.key < b.key) std::swap(b, c);
  if (b.key < a.key) std::swap(a, b);
  const glm::i64vec2 to_b = b.at_m - a.at_m;
  const glm::i64vec2 to_c = c.at_m - a.at_m;
  const double bx = static_cast<double>(to_b.x);
  const double bz = static_cast<double>(to_b.y);
  const double cx = static_cast<double>(to_c.x);
  const double cz = static_cast<double>(to_c.y);
  const double b2 = bx * bx + bz * bz;
  const double c2 = cx * cx + cz * cz;
  const double twice_area = 2 * (bx * cz - bz * cx);
  const glm::i64vec2 a_from_origin = a.at_m - origin_m;
  return {(cz * b2 - bz * c2) / twice_area + static_cast<double>(a_from_origin.x),
          (bx * c2 - cx * b2) / twice_area + static_cast<double>(a_from_origin.y)};
}

}  // namespace talus
