#include "client_sample/cli/coast_search.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include <glm/common.hpp>

#include "client_sample/cli/strips.hpp"
#include "client_sample/cli/world_block.hpp"
#include "core/base/hash.hpp"

namespace talus::cli {
namespace {

/// Edge of a block, and its lowest and highest voxel: from below the notch to above the highest cliffs.
constexpr int kSearchEdge = 192;
constexpr int kSearchBottom = -8;
constexpr int kSearchHeight = 128;
/// The slice that is searched: 2 m above the sea.
constexpr int kSlice = 2 - kSearchBottom;
constexpr int kOverhangGap = 2;
/// A cliff rises this much within this distance.
constexpr int kCliffRise = 10;
constexpr int kCliffReach = 6;
constexpr std::size_t kPlaces = 3;

/// What one block holds; all of its own, so that blocks can be looked at in any order.
struct BlockCount {
  int shore = 0, cliff = 0, arches = 0, caves = 0, overhangs = 0, loose = 0, loose_m3 = 0;
  std::vector<SurveyPlace> arch_places;
};

std::vector<glm::ivec2> shores_of(const SurveyGrid& grid) {
  std::vector<glm::ivec2> out;
  for (int k = 1; k + 1 < grid.edge; ++k) {
    for (int i = 1; i + 1 < grid.edge; ++i) {
      const float sea =
          std::min({grid.height(i - 1, k), grid.height(i + 1, k), grid.height(i, k - 1), grid.height(i, k + 1)});
      if (grid.height(i, k) >= 0 && sea < 0) out.emplace_back(i, k);
    }
  }
  return out;
}

/// Where the shore is between a column of the grid and its lowest neighbour, in voxels: halving finds it.
glm::i64vec2 shore_near(const WorldFunction& world, const SurveyGrid& grid, glm::ivec2 at, ColumnBlock& column) {
  glm::ivec2 lowest = at;
  for (const glm::ivec2 side : {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)}) {
    const glm::ivec2 to = at + side;
    if (grid.height(to.x, to.y) < grid.height(lowest.x, lowest.y)) lowest = to;
  }
  glm::i64vec2 land(glm::floor(grid.place_m(at.x, at.y) / world.voxel_m()));
  glm::i64vec2 sea(glm::floor(grid.place_m(lowest.x, lowest.y) / world.voxel_m()));
  while (std::max(std::abs(land.x - sea.x), std::abs(land.y - sea.y)) > 1) {
    const glm::i64vec2 middle = (land + sea) / std::int64_t{2};
    world.columns({middle.x, middle.y, 1, 1, 1, world.voxel_m()}, column);
    (column.height_m[0] >= 0 ? land : sea) = middle;
  }
  return land;
}

void count_block(const WorldFunction& world, glm::i64vec2 middle, DensityBrick& brick, BlockCount& out) {
  WorldBlock samples{{middle.x - kSearchEdge / 2, kSearchBottom, middle.y - kSearchEdge / 2},
                     kSearchEdge,
                     kSearchHeight,
                     kSearchEdge,
                     {},
                     {},
                     {},
                     {}};
  sample_block(world, brick, samples);
  const RockBlock block = rock_of(samples);
  out.shore = coast_cells(block, kSlice);
  out.cliff = cliff_cells(block, kSlice, kCliffRise, kCliffReach);
  out.overhangs = count_overhangs(block, kOverhangGap);
  const auto loose = find_detached(block);
  out.loose = static_cast<int>(loose.size());
  out.loose_m3 = loose.empty() ? 0 : loose.front();
  for (const Cavity& cavity : find_cavities(block, kSlice)) {
    out.caves += cavity.is_cave() ? 1 : 0;
    if (!cavity.is_arch()) continue;
    ++out.arches;
    const auto metres = [&](std::int64_t voxel) { return static_cast<double>(voxel) * world.voxel_m(); };
    out.arch_places.push_back(
        {"arch",
         {metres(samples.corner_voxel.x + cavity.x), 2, metres(samples.corner_voxel.z + cavity.z)},
         fmt::format("{} m2 under {:.0f} m of air", cavity.cells, cavity.clearance)});
    out.arch_places.back().worth = cavity.clearance * std::min(cavity.cells, 200);
  }
}

}  // namespace

CoastFigures search_coast(const WorldFunction& world, const SurveyGrid& grid, int blocks) {
  CoastFigures out;
  const auto shores = shores_of(grid);
  if (shores.empty() || blocks <= 0) return out;
  std::vector<BlockCount> counts(static_cast<std::size_t>(blocks));
  std::vector<DensityBrick> bricks(static_cast<std::size_t>(strip_workers()));
  std::vector<ColumnBlock> columns(bricks.size());
  for_each_strip("coast", blocks, [&](int n, int worker) {
    const auto w = static_cast<std::size_t>(worker);
    const std::uint64_t bits = mix64(mix64(0xC0A57, world.manifest().seed), static_cast<std::uint64_t>(n));
    const glm::i64vec2 middle = shore_near(world, grid, shores[bits % shores.size()], columns[w]);
    count_block(world, middle, bricks[w], counts[static_cast<std::size_t>(n)]);
  });
  int shore = 0;
  int cliff = 0;
  int overhangs = 0;
  for (const BlockCount& c : counts) {
    shore += c.shore;
    cliff += c.cliff;
    overhangs += c.overhangs;
    out.arches += c.arches;
    out.caves += c.caves;
    out.loose += c.loose;
    out.loose_m3 = std::max(out.loose_m3, c.loose_m3);
    out.places.insert(out.places.end(), c.arch_places.begin(), c.arch_places.end());
  }
  std::ranges::stable_sort(out.places, std::ranges::greater(), &SurveyPlace::worth);
  if (out.places.size() > kPlaces) out.places.resize(kPlaces);
  if (shore == 0) return out;
  out.shore_km = shore * world.voxel_m() * 1e-3;
  out.cliff_share = static_cast<double>(cliff) / shore;
  out.overhang_m2_per_m = static_cast<double>(overhangs) / shore * world.voxel_m();
  return out;
}

}  // namespace talus::cli
