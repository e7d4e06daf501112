#include "core/volume/carve_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/vec2.hpp>

#include "core/grid/wrap.hpp"
#include "core/volume/arch.hpp"
#include "core/volume/draw.hpp"

namespace talus {
namespace {

constexpr std::int64_t kListWindow = 16;

/// Newton steps that bring a candidate to its elevation, each at most this share of its cell.
constexpr int kProjectSteps = 6;
constexpr float kProjectShare = 0.4f;
constexpr float kElevationError_m = 0.3f;
/// Passes with a range of elevations up to this wide draw the elevation; others keep the candidate's own.
constexpr float kNarrowRange_m = 8.0f;
/// Share of the land's slope at large in the direction of growth: fine detail alone makes caves turn sideways.
constexpr float kInlandWide = 0.5f;
/// A sphere's roof grows with it.
constexpr float kRoofShare = 0.35f;
/// Spheres flatter than this are dropped.
constexpr float kRadiusMin_m = 0.8f;
/// Rock as high as a sphere's ceiling must stand behind it, as far as its radius and this: a sphere that goes through a
/// stack would leave its top in the air.
constexpr float kBehind_m = 3.0f;
/// The first spheres open a mouth: their roof is looked up this many radii further in.
constexpr int kMouthSpheres = 2;
constexpr float kMouthShare = 1.6f;
constexpr float kVerticalJitter = 0.4f;
/// Alcoves open this far below the base of the hard bed that they hang from, in metres, and are held to it by this
/// share of other spheres' jitter.
constexpr float kAlcoveBelow_m = 3.0f;
constexpr float kCeilingJitter = 0.1f;
/// Their steps along the wall, over those of others into it.
constexpr float kAlcoveStep = 1.6f;
constexpr float kArchStepShare = 0.55f;
constexpr float kArchFlare = 0.12f;
constexpr float kArchBelow_m = 0.5f;
constexpr float kArchOverhang = 0.3f;  ///< of its radius, before its mouths and behind them
/// Heights between wide nodes may leave their interval by this much and still be thought of.
constexpr float kOutlookSlack_m = 8.0f;

double on_lattice(double v) {
  return std::floor(v * 64.0 + 0.5) * 0x1p-6;
}

glm::vec2 unit(glm::vec2 v) {
  const float length = std::sqrt(v.x * v.x + v.y * v.y);
  return length > 0.0f ? glm::vec2{v.x / length, v.y / length} : glm::vec2{0.0f, 0.0f};
}

struct Seed {
  glm::dvec2 place_m;
  float y_m;
  glm::vec2 inland;                               ///< unit, against the wall's normal
  std::optional<float> ceiling_m = std::nullopt;  ///< base of the hard bed that spheres reach up to
};

/// Grows what one pass carves, cell by cell.
class Grower {
 public:
  Grower(const CarveControls& controls, CarveKind kind, Relief& relief, std::vector<CarveSphere>& out)
      : controls_(controls), pass_(controls.pass(kind)), kind_(kind), relief_(relief), out_(out) {}

  void cell(std::int64_t x, std::int64_t z) {
    const auto word = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
    const std::uint64_t seed = mix64(mix64(controls_.seed + static_cast<std::uint64_t>(kind_), word(x)), word(z));
    Draw draw(seed);
    if (draw.unit() >= pass_.probability) return;
    Seed at;
    if (!accept(x, z, draw, at)) return;
    if (kind_ == CarveKind::kArches) {
      arch(at, draw);
    } else {
      grow(at, draw);
    }
  }

 private:
  /// A candidate of a cell, moved to where it may be: to an elevation of its pass, and an alcove to the base of a hard
  /// bed. False where it cannot.
  bool accept(std::int64_t cell_x, std::int64_t cell_z, Draw& draw, Seed& out) {
    const glm::dvec2 corner{static_cast<double>(cell_x) * pass_.cell_m, static_cast<double>(cell_z) * pass_.cell_m};
    glm::dvec2 place{corner.x + static_cast<double>(draw.unit()) * pass_.cell_m,
                     corner.y + static_cast<double>(draw.unit()) * pass_.cell_m};
    ReliefPoint here = relief_.at(place.x, place.y);
    const bool narrow = pass_.elevation_high_m - pass_.elevation_low_m <= kNarrowRange_m;
    const float drawn = draw.between(pass_.elevation_low_m, pass_.elevation_high_m);
    const float wanted = narrow ? drawn : std::clamp(here.height_m, pass_.elevation_low_m, pass_.elevation_high_m);
    if (!project(corner, wanted, place, here)) return false;
    std::optional<float> ceiling_m;
    if (kind_ == CarveKind::kAlcoves) {
      ceiling_m = relief_.ceiling_near(place.x, place.y, here.height_m);
      if (!ceiling_m || !project(corner, *ceiling_m - kAlcoveBelow_m, place, here)) return false;
    }
    const ReliefPoint wide = relief_.wide_at(place.x, place.y);
    const glm::vec2 near_up = unit({here.slope_x, here.slope_z});
    const glm::vec2 wide_up = unit({wide.slope_x, wide.slope_z});
    out = {place, here.height_m, unit({near_up.x + kInlandWide * wide_up.x, near_up.y + kInlandWide * wide_up.y}),
           ceiling_m};
    return true;
  }

  /// Moves a place along the slope to an elevation; false where it leaves the cell at `corner`, or the slope is gentle.
  bool project(const glm::dvec2& corner, float wanted, glm::dvec2& place, ReliefPoint& here) {
    const float step_max = kProjectShare * static_cast<float>(pass_.cell_m);
    for (int n = 0; n < kProjectSteps && std::abs(here.height_m - wanted) > kElevationError_m; ++n) {
      const float slope2 = here.slope_x * here.slope_x + here.slope_z * here.slope_z;
      if (!(slope2 > 1e-4f)) return false;
      const float slope = std::sqrt(slope2);
      const float step = std::clamp((wanted - here.height_m) / slope, -step_max, step_max) / slope;
      place.x += static_cast<double>(here.slope_x * step);
      place.y += static_cast<double>(here.slope_z * step);
      if (!(place.x >= corner.x && place.x < corner.x + pass_.cell_m && place.y >= corner.y &&
            place.y < corner.y + pass_.cell_m))
        return false;
      here = relief_.at(place.x, place.y);
    }
    const float slope2 = here.slope_x * here.slope_x + here.slope_z * here.slope_z;
    return std::abs(here.height_m - wanted) <= kElevationError_m && slope2 >= pass_.slope_min * pass_.slope_min;
  }

  void grow(const Seed& seed, Draw& draw) {
    const int steps = draw.whole(pass_.steps_low, pass_.steps_high);
    int made = 0;
    glm::dvec2 centre = seed.place_m;
    float y_m = seed.y_m;
    // Alcoves are wider than deep: they follow their bed to both sides.
    const glm::vec2 along{-seed.inland.y, seed.inland.x};
    if (seed.ceiling_m) {
      const float back = 0.5f * kAlcoveStep * static_cast<float>(steps - 1) * pass_.step_m;
      centre -= glm::dvec2(along * back);
    }
    for (int step = 0; step < steps; ++step) {
      const float share = steps > 1 ? static_cast<float>(step) / static_cast<float>(steps - 1) : 0.0f;
      const float taper = 1.0f + (pass_.end_radius - 1.0f) * share;
      const int spheres = draw.whole(pass_.spheres_low, pass_.spheres_high);
      for (int n = 0; n < spheres; ++n, ++made) {
        const float radius = draw.between(pass_.radius_low_m, pass_.radius_high_m) * taper;
        const float jitter = pass_.jitter * radius;
        const glm::dvec2 place{centre.x + static_cast<double>(draw.between(-jitter, jitter)),
                               centre.y + static_cast<double>(draw.between(-jitter, jitter))};
        const float shift = kVerticalJitter * draw.between(-jitter, jitter);
        const float hung_m = seed.ceiling_m.value_or(0.0f) + (y_m - seed.y_m);
        const float height = seed.ceiling_m ? hung_m - radius * pass_.stretch + kCeilingJitter * shift : y_m + shift;
        roofed(seed, place, height, radius, made < kMouthSpheres);
      }
      const glm::vec2 way = seed.ceiling_m ? along * kAlcoveStep : seed.inland;
      centre.x += static_cast<double>(way.x * pass_.step_m);
      centre.y += static_cast<double>(way.y * pass_.step_m);
      y_m -= pass_.fall * pass_.step_m;
    }
  }

  /// The surface further inland than a place.
  float height_behind(const Seed& seed, glm::dvec2 place, float further_m) {
    return relief_.height_at(place.x + static_cast<double>(seed.inland.x * further_m),
                             place.y + static_cast<double>(seed.inland.y * further_m));
  }

  /// Adds a sphere as high as the rock above allows, where there is rock behind it.
  void roofed(const Seed& seed, glm::dvec2 place, float y_m, float radius, bool is_mouth) {
    const float surface = height_behind(seed, place, is_mouth ? kMouthShare * radius : 0.0f);
    const float room = surface - pass_.roof_m - kRoofShare * radius - y_m;
    const float vertical = std::min(radius * pass_.stretch, room);
    if (radius < kRadiusMin_m || !(vertical >= kRadiusMin_m)) return;
    if (height_behind(seed, place, radius + kBehind_m) < y_m + vertical) return;
    add(place, y_m, radius, radius / vertical);
  }

  void arch(const Seed& seed, Draw& draw) {
    const auto way = find_arch(controls_, relief_, seed.place_m, seed.y_m, seed.inland);
    if (!way) return;
    const float radius = std::min(way->radius_m, draw.between(pass_.radius_low_m, pass_.radius_high_m));
    const float step = kArchStepShare * radius;
    const float from = -kArchOverhang * radius;
    const int steps = static_cast<int>((way->length_m - 2.0f * from) / step);
    const float y_m = seed.y_m - kArchBelow_m;
    for (int i = 0; i <= steps; ++i) {
      const float s = from + static_cast<float>(i) * step;
      const float off_middle = std::abs(2.0f * s / way->length_m - 1.0f);
      const float r = radius * (1.0f + kArchFlare * off_middle * off_middle);
      const float jitter = pass_.jitter * radius;
      const glm::dvec2 place{
          seed.place_m.x + static_cast<double>(way->along.x * s + 0.5f * draw.between(-jitter, jitter)),
          seed.place_m.y + static_cast<double>(way->along.y * s + 0.5f * draw.between(-jitter, jitter))};
      add(place, y_m + 0.5f * kVerticalJitter * draw.between(-jitter, jitter), r, 1.0f / pass_.stretch);
    }
  }

  void add(glm::dvec2 place, float y_m, float radius, float inverse_stretch) {
    const auto exact = [](float v) { return static_cast<float>(on_lattice(static_cast<double>(v))); };
    out_.push_back({on_lattice(place.x), on_lattice(place.y), exact(y_m), exact(radius), inverse_stretch, kind_});
  }

  const CarveControls& controls_;
  const CarvePass& pass_;
  CarveKind kind_;
  Relief& relief_;
  std::vector<CarveSphere>& out_;
};

const std::vector<CarveSphere>& spheres_of_tile(const CarveControls& controls, Relief& relief, CarveMemory& memory,
                                                std::int64_t x, std::int64_t z) {
  memory.lists.resize(static_cast<std::size_t>(kListWindow * kListWindow));
  const std::int64_t slot = (x & (kListWindow - 1)) + (z & (kListWindow - 1)) * kListWindow;
  CarveMemory::List& list = memory.lists[static_cast<std::size_t>(slot)];
  const TileName name{relief.identity(), x, z};
  if (!list.known || list.name != name) {
    list.known = false;
    list.name = name;
    list.spheres.clear();
    grow_tile(controls, relief, x, z, list.spheres);
    list.known = true;
  }
  return list.spheres;
}

}  // namespace

void grow_tile(const CarveControls& controls, Relief& relief, std::int64_t x, std::int64_t z,
               std::vector<CarveSphere>& out) {
  const TileOutlook outlook = relief.outlook(x, z);
  if (outlook.rise <= kStillRise) return;
  for (std::size_t n = 0; n < kCarvePasses; ++n) {
    const CarvePass& pass = controls.passes[n];
    if (!(pass.probability > 0.0f) || outlook.high_m + kOutlookSlack_m < pass.elevation_low_m ||
        outlook.low_m - kOutlookSlack_m > pass.elevation_high_m)
      continue;
    // Cells whose lower corner lies in the tile: every cell belongs to one tile.
    const auto first_cell = [&](std::int64_t tile) {
      return static_cast<std::int64_t>(std::ceil(static_cast<double>(tile) * kFineTile_m / pass.cell_m));
    };
    Grower grower(controls, static_cast<CarveKind>(n), relief, out);
    for (std::int64_t cell_z = first_cell(z); cell_z < first_cell(z + 1); ++cell_z) {
      for (std::int64_t cell_x = first_cell(x); cell_x < first_cell(x + 1); ++cell_x) grower.cell(cell_x, cell_z);
    }
  }
  if (out.size() > kSpheresPerTile) out.resize(kSpheresPerTile);
}

bool lies_on(const ColumnGrid& grid, double lattice_m) {
  const auto lattice = static_cast<std::int64_t>(lattice_m / grid.voxel_m);
  return grid.step_voxel % lattice == 0 && grid.x_voxel % lattice == 0 && grid.z_voxel % lattice == 0;
}

void gather_spheres(const CarveControls& controls, Relief& relief, CarveMemory& memory, const ColumnGrid& grid,
                    std::vector<CarveSphere>& out) {
  out.clear();
  if (lies_on(grid, kStill_m)) return;
  const auto metres = [&](std::int64_t voxel) { return static_cast<double>(voxel) * grid.voxel_m; };
  const double low_x = metres(grid.x_voxel);
  const double low_z = metres(grid.z_voxel);
  const double high_x = metres(grid.x_voxel + (grid.width - 1) * grid.step_voxel);
  const double high_z = metres(grid.z_voxel + (grid.depth - 1) * grid.step_voxel);
  // A seed lies at most one cell beyond its tile's edge.
  double cell_max = 0;
  for (const CarvePass& pass : controls.passes) cell_max = std::max(cell_max, pass.cell_m);
  const double margin = kCarveReach_m + cell_max;
  const auto tiles_around = static_cast<std::int64_t>(period_m(grid) / kFineTile_m);
  const auto tile = [](double at) { return static_cast<std::int64_t>(std::floor(at / kFineTile_m)); };
  for (std::int64_t z = tile(low_z - margin); z <= tile(high_z + kCarveReach_m); ++z) {
    for (std::int64_t x = tile(low_x - margin); x <= tile(high_x + kCarveReach_m); ++x) {
      // Where the world wraps, the seeds of a tile are those of the one that it repeats.
      const std::int64_t home = wrapped(x, tiles_around);
      const double turn_m = static_cast<double>(x - home) * kFineTile_m;
      for (CarveSphere s : spheres_of_tile(controls, relief, memory, home, z)) {
        s.x_m += turn_m;
        const double reach = static_cast<double>(s.radius_m + kCarveBand_m);
        if (s.x_m + reach < low_x || s.x_m - reach > high_x || s.z_m + reach < low_z || s.z_m - reach > high_z)
          continue;
        out.push_back(s);
      }
    }
  }
}

}  // namespace talus
