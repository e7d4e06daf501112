// Which cones there are, and of what kind: chance by cell. The shapes are core/landforms/cones.cpp.
#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"
#include "core/grid/wrap.hpp"
#include "core/landforms/cones.hpp"

namespace talus {
namespace {

/// A centre lies anywhere in its cell but on its edge, or cones would stand in rows; and its cones reach this far, in
/// cells.
constexpr double kJitter = 0.48;
constexpr double kReach = 0.7;
/// Fire comes up in provinces: chance is scaled by a value noise over so many cells, from none to this much.
constexpr double kProvince = 5;
constexpr double kProvinceMost = 2.2;
/// Ground below this is sea floor, in metres; between the two shores no cone stands, or bays would fill with them.
constexpr float kSeaFloor_m = -150.0f;
constexpr float kLand_m = 5.0f;

/// Uniform numbers of a site, one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double unit() { return static_cast<double>(mix64(seed_, next_++) >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  float real(double low, double high) { return static_cast<float>(between(low, high)); }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

/// The nearest place that is a column of every lattice: voxels are at most 4 m.
double snapped(double at_m) {
  return std::floor(at_m * 0.25) * 4.0;
}

double radius_max(const ConeControls& c) {
  return kReach * c.cell_m / kConeReach;
}

/// A direction of about length 1, without a sine: a point in the square's ring.
void step_away(Draw& draw, double& x, double& z) {
  x = draw.between(-1, 1);
  z = draw.between(-1, 1);
  const double length = std::sqrt(x * x + z * z);
  const double inverse = length > 1e-3 ? 1 / length : 0;
  x *= inverse;
  z *= inverse;
}

void grow_cinder_cones(const ConeControls& c, const ConeSite& site, Draw& draw, int count, double near_m, double far_m,
                       std::vector<Cone>& out) {
  const double reach_m = kReach * c.cell_m;
  for (int n = 0; n < count; ++n) {
    Cone cone;
    const double size = draw.between(0.45, 1.25);
    cone.height_m = static_cast<float>(c.cinder_m * size);
    cone.radius_m = cone.height_m * draw.real(2.4, 3.2);
    double x = 0;
    double z = 0;
    step_away(draw, x, z);
    const double away = draw.between(near_m, far_m);
    cone.x_m = snapped(site.x_m + x * away);
    cone.z_m = snapped(site.z_m + z * away);
    cone.crater = draw.real(0.22, 0.34);
    cone.crater_m = cone.height_m * draw.real(0.15, 0.3);
    cone.is_cinder = true;
    // A cone beyond its site's reach would be missed by grids near it.
    if (away + kConeReach * static_cast<double>(cone.radius_m) < reach_m - 4) out.push_back(cone);
  }
}

/// Scale of the chance of cell (x, z), x of the first turn; its mean over many cells is about 1.
double province(const ConeControls& c, std::int64_t x, std::int64_t z, std::int64_t around) {
  // Where the world wraps, a whole number of provinces makes a turn.
  const std::int64_t turn =
      around == 0 ? 0 : std::max<std::int64_t>(1, std::llround(static_cast<double>(around) / kProvince));
  const double at_x =
      static_cast<double>(x) * (turn == 0 ? 1 / kProvince : static_cast<double>(turn) / static_cast<double>(around));
  const double at_z = static_cast<double>(z) / kProvince;
  const double low_x = std::floor(at_x);
  const double low_z = std::floor(at_z);
  const auto corner = [&](int i, int k) {
    const auto px = static_cast<std::uint64_t>(wrapped(static_cast<std::int64_t>(low_x) + i, turn));
    const auto pz = static_cast<std::uint64_t>(static_cast<std::int64_t>(low_z) + k);
    return static_cast<double>(mix64(mix64(c.seed ^ 0xF17EULL, px), pz) >> 11) * 0x1p-53;
  };
  const double u = at_x - low_x;
  const double near = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
  const double far = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
  const double t = std::clamp((near + (far - near) * (at_z - low_z) - 0.25) / 0.5, 0.0, 1.0);
  return kProvinceMost * t * t * (3 - 2 * t);
}

}  // namespace

void find_cone_sites(const ConeControls& c, const ColumnGrid& grid, std::vector<ConeSite>& out) {
  out.clear();
  const double cell_m = fitted_cell_m(c.cell_m, period_m(grid));
  const std::int64_t around = cells_around(c.cell_m, period_m(grid));
  const double reach_m = kReach * c.cell_m;
  const auto cell = [&](double at_m) { return static_cast<std::int64_t>(std::floor(at_m / cell_m)); };
  const auto at = [&](std::int64_t voxel, int steps) {
    return static_cast<double>(voxel + steps * grid.step_voxel) * grid.voxel_m;
  };
  const double x0 = at(grid.x_voxel, 0);
  const double x1 = at(grid.x_voxel, grid.width - 1);
  const double z0 = at(grid.z_voxel, 0);
  const double z1 = at(grid.z_voxel, grid.depth - 1);
  // A centre lies within its cell, and 4 m beside it once it is snapped.
  const double look_m = reach_m + 4;
  for (std::int64_t cz = cell(z0 - look_m); cz <= cell(z1 + look_m); ++cz) {
    for (std::int64_t cx = cell(x0 - look_m); cx <= cell(x1 + look_m); ++cx) {
      ConeSite site;
      // In a world that wraps a site is that of its cell in the first turn, whole periods away.
      const std::int64_t x_cell = wrapped(cx, around);
      const std::int64_t turns = around == 0 ? 0 : (cx - x_cell) / around;
      const double turns_m = turns == 0 ? 0.0 : static_cast<double>(turns) * period_m(grid);
      site.hash = mix64(mix64(c.seed, static_cast<std::uint64_t>(x_cell)), static_cast<std::uint64_t>(cz));
      Draw draw(site.hash);
      // No province scales a share beyond kProvinceMost: most cells are told by one draw.
      const double chance = draw.unit();
      const double most = std::max(c.land_share, c.sea_share);
      if (chance >= kProvinceMost * most) continue;
      site.scale = province(c, x_cell, cz, around);
      if (chance >= site.scale * most) continue;
      site.x_m = snapped((static_cast<double>(x_cell) + 0.5 + draw.between(-kJitter, kJitter)) * cell_m) + turns_m;
      site.z_m = snapped((static_cast<double>(cz) + 0.5 + draw.between(-kJitter, kJitter)) * cell_m);
      const bool is_near =
          site.x_m > x0 - reach_m && site.x_m < x1 + reach_m && site.z_m > z0 - reach_m && site.z_m < z1 + reach_m;
      if (is_near) out.push_back(site);
    }
  }
}

void grow_cones(const ConeControls& c, const ConeSite& site, float ground_m, float hilliness, std::vector<Cone>& out) {
  Draw draw(site.hash);
  const double chance = draw.unit();  // the same draw that made the site likely
  draw.unit();
  draw.unit();
  const double radius_m = radius_max(c);
  const double size = draw.unit();
  Cone cone;
  cone.x_m = site.x_m;
  cone.z_m = site.z_m;
  if (ground_m < kSeaFloor_m) {
    if (chance >= site.scale * c.sea_share) return;
    cone.height_m = static_cast<float>(c.seamount_m * (0.3 + 1.15 * size * size));
    cone.radius_m = std::min(cone.height_m * draw.real(4.5, 7.0), static_cast<float>(radius_m));
    // Waves planed off every third at some height below the sea of today.
    if (draw.unit() < 0.35) cone.flat = draw.real(0.62, 0.85);
    cone.gullies = 0.45f;
    out.push_back(cone);
    return;
  }
  if (ground_m < kLand_m || chance >= site.scale * c.land_share) return;
  if (draw.unit() < 0.25 + 0.75 * static_cast<double>(hilliness)) {
    // On a range a cone crowns what is there already.
    const double crown = 1 - 0.45 * static_cast<double>(hilliness);
    cone.height_m = static_cast<float>(c.volcano_m * (0.55 + 0.45 * size) * crown);
    cone.radius_m = std::min(cone.height_m * draw.real(2.7, 3.6), static_cast<float>(radius_m));
    cone.crater = draw.real(0.06, 0.13);
    cone.crater_m = cone.height_m * draw.real(0.06, 0.16);
    cone.gullies = 0.62f;
    const double foot_m = static_cast<double>(cone.radius_m);
    out.push_back(cone);
    const int children = static_cast<int>(draw.between(0, 6.99));
    grow_cinder_cones(c, site, draw, children, 0.45 * foot_m, 1.15 * foot_m, out);
  } else {
    const int children = static_cast<int>(draw.between(4, 12.99));
    grow_cinder_cones(c, site, draw, children, 0, 0.45 * c.cell_m, out);
  }
}

double cones_bound(const ConeControls& c) {
  return std::max(1.0 * c.volcano_m, 1.45 * c.seamount_m) + 1.25 * c.cinder_m;
}

}  // namespace talus
