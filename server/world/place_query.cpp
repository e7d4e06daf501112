#include "server/world/place_query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/world/ray.hpp"

namespace talus::server {

namespace {

constexpr float kStandHeightMin = 2.0F;  ///< metres above the sea
constexpr float kStandSlopeMax = 0.5F;
constexpr int kSearchColumns = 64;
constexpr int kRefineColumns = 33;
constexpr std::size_t kCandidatesPerRing = 12;
/// Column spacings of the widening search, in voxels: 64 columns reach 0.5, 4, 33 and 131 km at a voxel of 1 m.
constexpr std::array<std::int64_t, 4> kSearchSteps{16, 128, 1024, 4096};

ColumnGrid grid_around(const WorldFunction& world, const glm::i64vec2& centre_voxel, std::int64_t step, int columns) {
  ColumnGrid grid;
  // Corners lie on the lattice of their step, so that the same columns are met again by others.
  const auto corner = [&](std::int64_t c) { return (c / step - columns / 2) * step; };
  grid.x_voxel = corner(centre_voxel.x);
  grid.z_voxel = corner(centre_voxel.y);
  grid.step_voxel = step;
  grid.width = columns;
  grid.depth = columns;
  grid.voxel_m = world.voxel_m();
  return grid;
}

struct Candidate {
  glm::i64vec2 voxel{};
  float height_m = 0.0F;
  double distance = 0.0;  ///< in voxels, squared
};

/// Columns of `block` where one can stand, the nearest to `near_voxel` first. Slopes are measured between columns where
/// these are a metre or so apart; further apart the relief's own slope has to do.
std::vector<Candidate> standing_columns(const ColumnBlock& block, const glm::i64vec2& near_voxel, double voxel_m) {
  std::vector<Candidate> out;
  const ColumnGrid& grid = block.grid;
  const bool is_fine = grid.step_voxel == 1;
  for (int k = 1; k + 1 < grid.depth; ++k) {
    for (int i = 1; i + 1 < grid.width; ++i) {
      const std::size_t at = static_cast<std::size_t>(k) * block.stride + static_cast<std::size_t>(i);
      const float height = block.height_m[at];
      const auto span_m = static_cast<float>(2.0 * voxel_m);
      const float slope_x = is_fine ? (block.height_m[at + 1] - block.height_m[at - 1]) / span_m : block.slope_x[at];
      const float slope_z = is_fine ? (block.height_m[at + block.stride] - block.height_m[at - block.stride]) / span_m
                                    : block.slope_z[at];
      if (!(height > kStandHeightMin) || !(std::hypot(slope_x, slope_z) < kStandSlopeMax)) continue;
      const glm::i64vec2 voxel{grid.x_voxel + i * grid.step_voxel, grid.z_voxel + k * grid.step_voxel};
      const auto dx = static_cast<double>(voxel.x - near_voxel.x);
      const auto dz = static_cast<double>(voxel.y - near_voxel.y);
      out.push_back({voxel, height, dx * dx + dz * dz});
    }
  }
  std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  return out;
}

glm::i64vec2 voxel_below(const WorldFunction& world, const glm::dvec2& place_m) {
  return {static_cast<std::int64_t>(std::floor(place_m.x / world.voxel_m())),
          static_cast<std::int64_t>(std::floor(place_m.y / world.voxel_m()))};
}

/// Bilinear, fractions 0..1 in x and z; `a` has four columns, rows of two.
double blend(const std::array<double, 4>& a, double fx, double fz) {
  const double near_row = a[0] + (a[1] - a[0]) * fx;
  const double far_row = a[2] + (a[3] - a[2]) * fx;
  return near_row + (far_row - near_row) * fz;
}

}  // namespace

double place_limit_m(const WorldFunction& world) {
  constexpr double kSearchM = 300'000.0;
  return static_cast<double>(kChunkLimit) * world.cells() * world.voxel_m() - kSearchM;
}

std::optional<glm::dvec3> standing_place(const WorldFunction& world, const glm::dvec2& near_m) {
  const glm::i64vec2 near_voxel = voxel_below(world, near_m);
  ColumnBlock coarse;
  ColumnBlock fine;
  for (const std::int64_t step : kSearchSteps) {
    world.columns(grid_around(world, near_voxel, step, kSearchColumns), coarse);
    std::vector<Candidate> candidates = standing_columns(coarse, near_voxel, world.voxel_m());
    candidates.resize(std::min(candidates.size(), kCandidatesPerRing));
    for (const Candidate& candidate : candidates) {
      world.columns(grid_around(world, candidate.voxel, 1, kRefineColumns), fine);
      const std::vector<Candidate> places = standing_columns(fine, near_voxel, world.voxel_m());
      if (places.empty()) continue;
      const Candidate& place = places.front();
      return glm::dvec3{static_cast<double>(place.voxel.x) * world.voxel_m(), static_cast<double>(place.height_m),
                        static_cast<double>(place.voxel.y) * world.voxel_m()};
    }
  }
  return std::nullopt;
}

std::string points_json(const WorldFunction& world, std::span<const glm::dvec2> places_m) {
  std::string out = "{\"points\":[";
  ColumnBlock block;
  for (const glm::dvec2& place : places_m) {
    const glm::i64vec2 voxel = voxel_below(world, place);
    ColumnGrid grid;
    grid.x_voxel = voxel.x;
    grid.z_voxel = voxel.y;
    grid.width = 2;
    grid.depth = 2;
    grid.voxel_m = world.voxel_m();
    world.columns(grid, block);
    const double fx = place.x / world.voxel_m() - static_cast<double>(voxel.x);
    const double fz = place.y / world.voxel_m() - static_cast<double>(voxel.y);
    const auto corners = [&](const std::vector<float>& values) {
      return std::array<double, 4>{values[0], values[1], values[block.stride], values[block.stride + 1]};
    };
    const std::array<double, 4> heights = corners(block.height_m);
    const double height = blend(heights, fx, fz);
    const double slope_x =
        (heights[1] - heights[0] + (heights[3] - heights[1] - heights[2] + heights[0]) * fz) / world.voxel_m();
    const double slope_z =
        (heights[2] - heights[0] + (heights[3] - heights[1] - heights[2] + heights[0]) * fx) / world.voxel_m();
    const double slope = std::hypot(slope_x, slope_z);
    const double ridge = blend(corners(block.ridge), fx, fz);
    const double up = 1.0 / std::sqrt(1.0 + slope * slope);
    const auto surface_m = static_cast<float>(height);
    Material material = world.cover({surface_m, static_cast<float>(up), static_cast<float>(ridge), block.hilliness[0],
                                     block.beach[0], voxel, block.districts_at(0)});
    const RockPlace under{block.stack_m[0], block.choice[0], surface_m, voxel};
    if (material == Material::kRock) material = world.rock(under);
    const LayerPlace layer = world.layer(under);
    const PlatePlace plate = world.plate_at(place, block.workspace);
    const DistrictShares districts = block.districts_at(0);
    const auto most = std::ranges::max_element(districts);
    // What has less than half of the ground is a border, not a name.
    const std::string_view district =
        *most < 0.5f ? "" : kDistrictNames[static_cast<std::size_t>(most - districts.begin())];
    if (out.back() != '[') out += ',';
    fmt::format_to(
        std::back_inserter(out),
        R"({{"x":{},"z":{},"height_m":{:.3f},"slope":{:.4f},"material":"{}","layer":{},"layer_set":{},)"
        R"("plate":"{},{}","plate_kind":"{}","fault":"{}","fault_m":{:.1f},"ridge":{:.4f},"district":"{}"}})",
        place.x, place.y, height, slope, info_of(material).name, layer.index, layer.set, plate.plate.key.x,
        plate.plate.key.z, plate.traits.kind == PlateKind::kContinental ? "continental" : "oceanic",
        name_of(plate.fault), std::abs(plate.fault_m), ridge, district);
  }
  return out + "]}";
}

double ray_limit_m(const WorldFunction& world) {
  return kRayVoxelsMax * world.voxel_m();
}

std::string ray_json(const WorldFunction& world, const glm::dvec3& from_m, const glm::dvec3& direction, double max_m) {
  DensityBrick brick;
  const auto hit = cast_ray(world, from_m, direction, max_m, brick);
  if (!hit) return "null";
  const glm::dvec3& p = hit->position_m;
  const glm::dvec3& n = hit->normal;
  return fmt::format(
      R"({{"position":[{:.4f},{:.4f},{:.4f}],"normal":[{:.4f},{:.4f},{:.4f}],"material":"{}","distance_m":{:.4f}}})",
      p.x, p.y, p.z, n.x, n.y, n.z, info_of(hit->material).name, hit->distance_m);
}

}  // namespace talus::server
