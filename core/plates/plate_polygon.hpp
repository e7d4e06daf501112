// The Voronoi polygon of a site. Pure; private to core/plates.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "core/plates/plate_sites.hpp"

namespace talus {

/// A side of a polygon: the site behind it, and the corner it starts at, in metres from the polygon's own site. Corners
/// run around the polygon, so a side ends where the next one starts.
struct PolygonSide {
  Site neighbour;
  glm::dvec2 start_m{};
};

/// The polygon of `site`: every neighbour of it, in order around it.
///
/// Which sites are looked at: those of the 3x3 squares around the site's own, then of 5x5, then of 7x7, until no site
/// outside could cut: one at distance r cuts at r / 2, so none does beyond twice the polygon's farthest corner. 7x7 is
/// always enough: corners are within kSiteReach = 2.06 cells (else another site would be nearer), so neighbours are
/// within 4.12 cells, and 7x7 squares reach 6 cells in every direction.
std::vector<PolygonSide> polygon_of(const PlateSites& sites, const Site& site);

/// The point at equal distance of three sites, in metres from `origin`: the same bits for the three in any order.
glm::dvec2 vertex_of(Site a, Site b, Site c, const glm::i64vec2& origin_m);

}  // namespace talus
