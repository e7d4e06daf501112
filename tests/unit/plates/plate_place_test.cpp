#include "core/plates/plate_place.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/plates/fault_curve.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

/// The way of the map: faults are drawn on tiles, and every plate floods them from its site.
class TileMap {
 public:
  static constexpr int kTiles = 512;
  static constexpr double kTile_m = 256;

  TileMap(const PlateBuilder& builder, const glm::i64vec2& corner_m)
      : corner_m_(corner_m), tiles_(static_cast<std::size_t>(kTiles) * kTiles, kEmpty) {
    const std::int64_t extent_m = static_cast<std::int64_t>(kTiles * kTile_m);
    const PlateSites& sites = builder.sites();
    for (std::int64_t z = sites.square_of(corner_m.y) - 2; z <= sites.square_of(corner_m.y + extent_m) + 2; ++z) {
      for (std::int64_t x = sites.square_of(corner_m.x) - 2; x <= sites.square_of(corner_m.x + extent_m) + 2; ++x)
        sites.add_sites(x, z, sites_);
    }
    Plate plate;
    for (const Site& site : sites_) {
      builder.build(site.key, plate);
      for (const PlateFault& fault : plate.faults) draw(plate, fault);
    }
    for (std::size_t n = 0; n < sites_.size(); ++n) flood(static_cast<int>(n));
  }

  glm::dvec2 centre(int x, int z) const {
    return glm::dvec2(corner_m_) + glm::dvec2{(x + 0.5) * kTile_m, (z + 0.5) * kTile_m};
  }
  bool is_fault(int x, int z) const { return at(x, z) == kFault; }
  bool is_flooded(int x, int z) const { return at(x, z) >= 0; }
  SiteKey owner(int x, int z) const { return sites_[static_cast<std::size_t>(at(x, z))].key; }

 private:
  static constexpr int kEmpty = -1;
  static constexpr int kFault = -2;

  int at(int x, int z) const { return tiles_[static_cast<std::size_t>(z) * kTiles + static_cast<std::size_t>(x)]; }
  int* tile(const glm::dvec2& from_corner_m) {
    const auto x = static_cast<int>(std::floor(from_corner_m.x / kTile_m));
    const auto z = static_cast<int>(std::floor(from_corner_m.y / kTile_m));
    if (x < 0 || z < 0 || x >= kTiles || z >= kTiles) return nullptr;
    return &tiles_[static_cast<std::size_t>(z) * kTiles + static_cast<std::size_t>(x)];
  }
  void draw(const Plate& plate, const PlateFault& fault) {
    const glm::dvec2 front(plate.seat.site.at_m + fault.front_from_site - corner_m_);
    const auto steps = static_cast<int>(fault.length_m / (0.1 * kTile_m)) + 2;
    for (int i = 0; i <= steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      const float u = t * fault.length_m;
      const float bend = curve_at(&plate.curves[fault.curve.full], fault.curve.samples, t);
      const glm::dvec2 p = front + glm::dvec2{fault.start_x + u * fault.along_x + bend * fault.across_x,
                                              fault.start_z + u * fault.along_z + bend * fault.across_z};
      if (int* found = tile(p)) *found = kFault;
    }
  }
  void flood(int plate) {
    const Site& site = sites_[static_cast<std::size_t>(plate)];
    const glm::dvec2 from_corner(site.at_m - corner_m_);
    std::vector<glm::ivec2> open;
    const auto visit = [&](int x, int z) {
      if (x < 0 || z < 0 || x >= kTiles || z >= kTiles || at(x, z) != kEmpty) return;
      tiles_[static_cast<std::size_t>(z) * kTiles + static_cast<std::size_t>(x)] = plate;
      open.emplace_back(x, z);
    };
    visit(static_cast<int>(std::floor(from_corner.x / kTile_m)), static_cast<int>(std::floor(from_corner.y / kTile_m)));
    while (!open.empty()) {
      const glm::ivec2 p = open.back();
      open.pop_back();
      visit(p.x + 1, p.y);
      visit(p.x - 1, p.y);
      visit(p.x, p.y + 1);
      visit(p.x, p.y - 1);
    }
  }

  glm::i64vec2 corner_m_;
  std::vector<int> tiles_;
  std::vector<Site> sites_;
};

TEST(PlatePlace, IsTheOwnerThatFloodsFindEverywhereButOnFaults) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    PlateControls controls;
    controls.seed = seed;
    const PlateBuilder builder(controls, MacroControls{});
    const glm::i64vec2 corner{seed == 3 ? 999'000'000 : -70'000, seed == 3 ? -999'000'000 : 30'000};
    const TileMap map(builder, corner);
    PlateMemo memo;
    int flooded = 0;
    int pockets = 0;
    // Plates whose site lies outside flood nothing: look at those well inside.
    for (int z = 128; z < 128 + test::rounds(256); ++z) {
      for (int x = 128; x < 384; ++x) {
        if (map.is_fault(x, z)) continue;
        if (!map.is_flooded(x, z)) {
          ++pockets;
          continue;
        }
        ++flooded;
        const PlatePlace place = place_at(builder, map.centre(x, z), memo);
        ASSERT_EQ(place.plate.key, map.owner(x, z)) << "seed " << seed << " tile " << x << ' ' << z;
      }
    }
    EXPECT_GT(flooded, test::rounds(50'000)) << "seed " << seed;
    // Bends of a fault can cut off a few tiles from their plate's site.
    EXPECT_LT(pockets, 300) << "seed " << seed;
  }
}

TEST(PlatePlace, ChangesOwnerOnlyWhereItsFaultIs) {
  PlateControls controls;
  controls.seed = 5;
  const PlateBuilder builder(controls, MacroControls{});
  test::Random random(5);
  PlateMemo memo;
  int crossings = 0;
  for (int n = 0; n < 40; ++n) {
    glm::dvec2 at{random.real(-1e6, 1e6), random.real(-1e6, 1e6)};
    PlatePlace last = place_at(builder, at, memo);
    for (int i = 0; i < 400; ++i) {
      at += glm::dvec2{50, 20};
      const PlatePlace here = place_at(builder, at, memo);
      if (here.plate.key != last.plate.key) {
        ++crossings;
        // Distances are taken across the fault's straight line: up to twice the step where its curve is steep.
        ASSERT_LT(std::abs(here.fault_m), 150.0f) << "a step of 54 m changed the plate far from any fault";
        ASSERT_LT(std::abs(last.fault_m), 150.0f);
      } else {
        ASSERT_EQ(here.traits.kind, last.traits.kind);
      }
      ASSERT_EQ(here.is_front, here.fault_m >= 0);
      last = here;
    }
  }
  EXPECT_GT(crossings, 20);
}

}  // namespace
}  // namespace talus
