#include "core/plates/plate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/plates/fault_curve.hpp"
#include "core/plates/plate_memo.hpp"
#include "core/plates/plate_polygon.hpp"
#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kPlateSeed = 1912;

PlateBuilder builder_of(std::uint64_t seed) {
  PlateControls plates;
  plates.seed = seed;
  return {plates, MacroControls{}};
}

/// Sites of the squares within `reach` of one square.
std::vector<Site> sites_around(const PlateSites& sites, const glm::i64vec2& square, std::int64_t reach) {
  std::vector<Site> out;
  for (std::int64_t z = -reach; z <= reach; ++z) {
    for (std::int64_t x = -reach; x <= reach; ++x) sites.add_sites(square.x + x, square.y + z, out);
  }
  return out;
}

/// Plates here and there in several worlds, some of them 10^9 m away.
template <class Visit>
void for_some_plates(Visit visit) {
  test::Random random(kPlateSeed);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const PlateBuilder builder = builder_of(seed);
    const std::int64_t reach = seed % 2 == 0 ? 20 : 30'000;
    for (int n = 0; n < 12; ++n) {
      for (const Site& site :
           sites_around(builder.sites(), {random.whole(-reach, reach), random.whole(-reach, reach)}, 0))
        visit(builder, site);
    }
  }
}

float displacement(const Plate& plate, const PlateFault& fault, float t) {
  return curve_at(&plate.curves[fault.curve.full], fault.curve.samples, t);
}

TEST(PlateSites, LeaveNoPlaceFartherThanTheirReach) {
  test::Random random(kPlateSeed);
  PlateControls controls;
  controls.jitter = 0.9;
  const PlateSites sites(controls, MacroControls{});
  for (int n = 0; n < 2'000; ++n) {
    const glm::i64vec2 at{random.whole(-9'000'000, 9'000'000), random.whole(-9'000'000, 9'000'000)};
    double nearest = 1e300;
    for (const Site& s : sites_around(sites, {sites.square_of(at.x), sites.square_of(at.y)}, 2)) {
      const glm::dvec2 away(s.at_m - at);
      nearest = std::min(nearest, std::hypot(away.x, away.y));
    }
    ASSERT_LT(nearest, kSiteReach * controls.size_m);
  }
}

TEST(PlateSites, MakePlatesOfTwoSizes) {
  const PlateBuilder builder = builder_of(1);
  const auto found = sites_around(builder.sites(), {0, 0}, 20);
  // 41 x 41 squares, 30 % of them with one site and the others with four.
  const double per_square = static_cast<double>(found.size()) / (41.0 * 41.0);
  EXPECT_NEAR(per_square, 0.3 + 0.7 * 4, 0.15);
  for (const Site& s : found) EXPECT_EQ(builder.sites().site(s.key), s);
}

TEST(PlatePolygon, HasEveryNeighbourAndNoneToSpare) {
  for_some_plates([](const PlateBuilder& builder, const Site& site) {
    const auto sides = polygon_of(builder.sites(), site);
    const glm::i64vec2 square{builder.sites().square_of(site.at_m.x), builder.sites().square_of(site.at_m.y)};
    const auto all = sites_around(builder.sites(), square, 5);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      // Halfway along a side its two sites are the nearest of all.
      const glm::dvec2 middle = (sides[i].start_m + sides[(i + 1) % sides.size()].start_m) * 0.5;
      const auto distance = [&](const Site& s) {
        const glm::dvec2 away = glm::dvec2(s.at_m - site.at_m) - middle;
        return std::hypot(away.x, away.y);
      };
      const double own = distance(site);
      ASSERT_NEAR(distance(sides[i].neighbour), own, 1e-4);
      for (const Site& s : all) {
        if (s.key != site.key && s.key != sides[i].neighbour.key) {
          ASSERT_GT(distance(s), own - 1e-4);
        }
      }
    }
  });
}

TEST(PlateFault, IsTheSameBitsFromBothItsPlates) {
  int faults = 0;
  for_some_plates([&](const PlateBuilder& builder, const Site& site) {
    Plate mine;
    Plate theirs;
    builder.build(site.key, mine);
    for (const PlateFault& a : mine.faults) {
      builder.build(a.side > 0 ? a.back : a.front, theirs);
      const auto found = std::ranges::find_if(
          theirs.faults, [&](const PlateFault& b) { return a.front == b.front && a.back == b.back; });
      ASSERT_NE(found, theirs.faults.end());
      PlateFault b = *found;
      EXPECT_EQ(b.side, -a.side);
      b.side = a.side;
      b.front_from_site = a.front_from_site;
      b.curve = a.curve;
      const auto numbers = [](const PlateFault& f) {
        return std::vector<float>{f.start_x,
                                  f.start_z,
                                  f.along_x,
                                  f.along_z,
                                  f.across_x,
                                  f.across_z,
                                  f.length_m,
                                  f.foot_t,
                                  f.half_m,
                                  f.reach_m,
                                  f.features.scale,
                                  f.features.crest_m,
                                  f.features.trench_m,
                                  f.features.hilliness,
                                  f.start_crest_m,
                                  f.end_crest_m,
                                  f.start_hilliness,
                                  f.end_hilliness,
                                  f.front_m,
                                  f.back_m,
                                  f.blend_m,
                                  f.weight};
      };
      ASSERT_EQ(numbers(a), numbers(b));
      ASSERT_EQ(a.features.kind, b.features.kind);
      ASSERT_EQ(found->curve.samples, a.curve.samples);
      const std::size_t bytes = curve_floats(a.curve.samples) * sizeof(float);
      ASSERT_EQ(std::memcmp(&mine.curves[a.curve.full], &theirs.curves[found->curve.full], bytes), 0);
      ASSERT_EQ(std::memcmp(&mine.curves[a.curve.broad], &theirs.curves[found->curve.broad], bytes), 0);
      ++faults;
    }
  });
  EXPECT_GT(faults, 300);
}

TEST(PlateFault, IsNotDisplacedAtItsVerticesAndLeavesThemStraight) {
  for_some_plates([](const PlateBuilder& builder, const Site& site) {
    Plate plate;
    builder.build(site.key, plate);
    for (const PlateFault& fault : plate.faults) {
      ASSERT_EQ(displacement(plate, fault, 0.0f), 0.0f);
      ASSERT_EQ(displacement(plate, fault, 1.0f), 0.0f);
      const float step = 1e-3f;
      ASSERT_LT(std::abs(displacement(plate, fault, step)), 0.02f * step * fault.length_m);
      ASSERT_LT(std::abs(displacement(plate, fault, 1 - step)), 0.02f * step * fault.length_m);
    }
  });
}

TEST(PlateFault, BendsWithinItsKite) {
  float widest = 0;
  for_some_plates([&](const PlateBuilder& builder, const Site& site) {
    Plate plate;
    builder.build(site.key, plate);
    for (const PlateFault& fault : plate.faults) {
      for (int i = 1; i < 1'000; ++i) {
        const float t = static_cast<float>(i) / 1'000.0f;
        float width = 1e30f;
        if (fault.foot_t > 0) width = std::min(width, fault.half_m * t / fault.foot_t);
        if (fault.foot_t < 1) width = std::min(width, fault.half_m * (1 - t) / (1 - fault.foot_t));
        const float bend = std::abs(displacement(plate, fault, t));
        ASSERT_LT(bend, width);
        ASSERT_LE(bend, fault.reach_m);
        widest = std::max(widest, bend);
      }
    }
  });
  EXPECT_GT(widest, 1'000.0f) << "faults are straight";
}

TEST(PlateMemo, GivesThePlateThatIsBuiltAndKnowsWorldsApart) {
  const PlateBuilder one = builder_of(1);
  const PlateBuilder two = builder_of(2);
  test::Random random(kPlateSeed);
  PlateMemo memo;
  for (int n = 0; n < 200; ++n) {
    const PlateBuilder& builder = n % 3 == 0 ? two : one;
    const auto sites = sites_around(builder.sites(), {random.whole(-9, 9), random.whole(-9, 9)}, 0);
    Plate fresh;
    builder.build(sites[0].key, fresh);
    const Plate& kept = memo.load(builder, sites[0].key);
    ASSERT_EQ(kept.seat.site, fresh.seat.site);
    ASSERT_EQ(kept.curves, fresh.curves);
  }
}

TEST(PlateFault, HasTheSameCurveOnEveryTarget) {
  const PlateBuilder builder = builder_of(3);
  Plate best;
  builder.build(sites_around(builder.sites(), {5, 5}, 0)[0].key, best);
  const int targets = test::for_each_simd_target([&](const char* target) {
    Plate plate;
    builder.build(best.seat.site.key, plate);
    ASSERT_EQ(std::memcmp(plate.curves.data(), best.curves.data(), best.curves.size() * sizeof(float)), 0) << target;
  });
  EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace talus
