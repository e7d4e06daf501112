#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "client_sample/cli/survey.hpp"

namespace talus::cli {
namespace {

struct Candidate {
  double worth = 0;
  int i = 0, k = 0;
};

/// The best `count` candidates that are a tenth of the square apart.
std::vector<Candidate> best_of(std::vector<Candidate> all, std::size_t count, int edge) {
  std::ranges::stable_sort(all, [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  std::vector<Candidate> out;
  for (const Candidate& c : all) {
    const bool is_apart =
        std::ranges::all_of(out, [&](const Candidate& o) { return std::hypot(o.i - c.i, o.k - c.k) > edge / 10.0; });
    if (is_apart) out.push_back(c);
    if (out.size() == count) break;
  }
  return out;
}

/// Candidates of every column at least `margin` from the edge for which `worth(i, k)` is above 0.
template <typename Worth>
std::vector<Candidate> candidates(const SurveyGrid& grid, int margin, Worth worth) {
  std::vector<Candidate> out;
  for (int k = margin; k + margin < grid.edge; ++k) {
    for (int i = margin; i + margin < grid.edge; ++i) {
      if (const double w = worth(i, k); w > 0) out.push_back({w, i, k});
    }
  }
  return out;
}

/// How high a column stands above all its neighbours, then by height.
double peak_worth(const SurveyGrid& g, int i, int k) {
  const float h = g.height(i, k);
  for (int dk = -1; dk <= 1; ++dk) {
    for (int di = -1; di <= 1; ++di) {
      if ((di != 0 || dk != 0) && g.height(i + di, k + dk) >= h) return 0;
    }
  }
  return static_cast<double>(h);
}

/// Depth below the lower of two walls `reach` columns away on opposite sides.
double canyon_worth(const SurveyGrid& g, int i, int k, int reach) {
  const float h = g.height(i, k);
  if (h < 3) return 0;
  const float east_west = std::min(g.height(i - reach, k), g.height(i + reach, k)) - h;
  const float north_south = std::min(g.height(i, k - reach), g.height(i, k + reach)) - h;
  return static_cast<double>(std::max(east_west, north_south));
}

/// Height of the land one column from the sea.
double cliff_worth(const SurveyGrid& g, int i, int k) {
  const float h = g.height(i, k);
  if (h < 0) return 0;
  const float lowest = std::min({g.height(i - 1, k), g.height(i + 1, k), g.height(i, k - 1), g.height(i, k + 1)});
  return lowest < 0 ? static_cast<double>(h) : 0;
}

/// Connected pieces of land or sea, by flood fill from column to column.
struct Piece {
  int columns = 0;
  int i = 0, k = 0;  ///< one of them
  bool touches_edge = false;
};
std::vector<Piece> pieces_of(const SurveyGrid& g, bool of_land) {
  std::vector<bool> seen(g.height_m.size());
  std::vector<Piece> out;
  std::vector<glm::ivec2> open;
  const auto visit = [&](int i, int k) {
    const std::size_t at = g.index(i, k);
    if (seen[at] || (g.height_m[at] >= 0) != of_land) return;
    seen[at] = true;
    open.emplace_back(i, k);
  };
  for (int k = 0; k < g.edge; ++k) {
    for (int i = 0; i < g.edge; ++i) {
      visit(i, k);
      if (open.empty()) continue;
      Piece piece{0, i, k, false};
      while (!open.empty()) {
        const glm::ivec2 at = open.back();
        open.pop_back();
        ++piece.columns;
        piece.touches_edge |= at.x == 0 || at.y == 0 || at.x == g.edge - 1 || at.y == g.edge - 1;
        if (at.x > 0) visit(at.x - 1, at.y);
        if (at.x + 1 < g.edge) visit(at.x + 1, at.y);
        if (at.y > 0) visit(at.x, at.y - 1);
        if (at.y + 1 < g.edge) visit(at.x, at.y + 1);
      }
      out.push_back(piece);
    }
  }
  return out;
}

/// The island with the most other islands within an eighth of the square.
std::optional<std::pair<Piece, int>> island_chain(const SurveyGrid& g) {
  std::vector<Piece> islands;
  for (const Piece& p : pieces_of(g, true)) {
    if (!p.touches_edge && p.columns >= 4) islands.push_back(p);
  }
  std::optional<std::pair<Piece, int>> best;
  for (const Piece& p : islands) {
    const auto near = static_cast<int>(std::ranges::count_if(
        islands, [&](const Piece& o) { return std::hypot(o.i - p.i, o.k - p.k) < g.edge / 8.0; }));
    if (near >= 3 && (!best || near > best->second)) best = {p, near};
  }
  return best;
}

/// The deepest place on a rift's axis: as far below the highest ground nearby as anywhere.
std::optional<SurveyPlace> rift(const WorldFunction& world, const SurveyGrid& g) {
  constexpr double kAxis_m = 1500;
  constexpr double kShoulder_m = 4000;
  const int stride = std::max(1, g.edge / 128);
  const int reach = std::max(1, static_cast<int>(kShoulder_m / g.spacing_m));
  ColumnWorkspace workspace;
  std::optional<SurveyPlace> best;
  float deepest = 100;
  for (int k = reach; k + reach < g.edge; k += stride) {
    for (int i = reach; i + reach < g.edge; i += stride) {
      const glm::dvec2 place = g.place_m(i, k);
      const PlatePlace at = world.plate_at(place, workspace);
      if (at.fault != FaultClass::kRift || std::abs(static_cast<double>(at.fault_m)) > kAxis_m) continue;
      const float shoulder = std::max(std::min(g.height(i - reach, k), g.height(i + reach, k)),
                                      std::min(g.height(i, k - reach), g.height(i, k + reach)));
      const float depth = shoulder - g.height(i, k);
      if (depth <= deepest) continue;
      deepest = depth;
      best = SurveyPlace{"rift",
                         {place.x, static_cast<double>(g.height(i, k)), place.y},
                         fmt::format("{:.0f} m below its shoulders", depth)};
    }
  }
  return best;
}

/// The overhang with the most air below it, of columns a few metres apart around the highest shores.
std::optional<SurveyPlace> overhang(const WorldFunction& world, const SurveyGrid& g,
                                    const std::vector<Candidate>& cliffs) {
  std::optional<SurveyPlace> best;
  double most_air = 1.5;
  DensityBrick brick;
  for (const Candidate& cliff : cliffs) {
    for (int k = -6; k <= 6; ++k) {
      for (int i = -6; i <= 6; ++i) {
        const glm::dvec2 place = g.place_m(cliff.i, cliff.k) + glm::dvec2(i, k) * (g.spacing_m / 6);
        const Overhang found = overhang_at(world, place, brick);
        if (!found.is_there || found.air_m <= most_air) continue;
        most_air = found.air_m;
        best = SurveyPlace{"overhang",
                           {place.x, found.roof_m - found.air_m, place.y},
                           fmt::format("{:.0f} m of air under rock", found.air_m)};
      }
    }
  }
  return best;
}

}  // namespace

std::vector<SurveyPlace> survey_places(const WorldFunction& world, const SurveyGrid& grid) {
  std::vector<SurveyPlace> out;
  const auto add = [&](std::string kind, int i, int k, std::string why) {
    const glm::dvec2 place = grid.place_m(i, k);
    out.push_back({std::move(kind), {place.x, static_cast<double>(grid.height(i, k)), place.y}, std::move(why)});
  };
  for (const Candidate& c :
       best_of(candidates(grid, 1, [&](int i, int k) { return peak_worth(grid, i, k); }), 3, grid.edge)) {
    add("peak", c.i, c.k, fmt::format("{:.0f} m high", c.worth));
  }
  const int reach = std::clamp(static_cast<int>(600 / grid.spacing_m), 1, grid.edge / 8);
  const auto canyon = [&](int i, int k) { return canyon_worth(grid, i, k, reach); };
  for (const Candidate& c : best_of(candidates(grid, reach, canyon), 2, grid.edge)) {
    add("canyon", c.i, c.k,
        fmt::format("{:.0f} m deep between walls {:.0f} m apart", c.worth, 2 * reach * grid.spacing_m));
  }
  const auto cliffs =
      best_of(candidates(grid, 1, [&](int i, int k) { return cliff_worth(grid, i, k); }), 12, grid.edge);
  for (std::size_t n = 0; n < std::min<std::size_t>(2, cliffs.size()); ++n) {
    add("sea cliff", cliffs[n].i, cliffs[n].k,
        fmt::format("{:.0f} m within {:.0f} m of the sea", cliffs[n].worth, grid.spacing_m));
  }
  if (const auto chain = island_chain(grid)) {
    add("island chain", chain->first.i, chain->first.k,
        fmt::format("{} islands within {:.0f} km", chain->second, grid.edge / 8.0 * grid.spacing_m / 1000));
  }
  const auto waters = pieces_of(grid, false);
  const auto lake = std::ranges::max_element(waters, {}, [](const Piece& p) { return p.touches_edge ? 0 : p.columns; });
  if (lake != waters.end() && !lake->touches_edge) {
    add("inland water", lake->i, lake->k,
        fmt::format("{:.1f} km2", lake->columns * grid.spacing_m * grid.spacing_m * 1e-6));
  }
  const auto deepest = static_cast<int>(std::ranges::min_element(grid.height_m) - grid.height_m.begin());
  if (grid.height_m[static_cast<std::size_t>(deepest)] < 0) {
    add("trench", deepest % grid.edge, deepest / grid.edge,
        fmt::format("{:.0f} m deep", -grid.height_m[static_cast<std::size_t>(deepest)]));
  }
  if (auto found = rift(world, grid)) out.push_back(std::move(*found));
  if (auto found = overhang(world, grid, cliffs)) out.push_back(std::move(*found));
  return out;
}

}  // namespace talus::cli
