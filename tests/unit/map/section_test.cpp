#include "core/map/section.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/default_world.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

using test::world;

struct Cut {
  SectionView view;
  std::vector<std::uint8_t> rgb;

  std::array<int, 3> at(int i, double y_m) const {
    const double pixel_m = (view.high_m - view.low_m) / view.height;
    const int k = static_cast<int>((view.high_m - y_m) / pixel_m);
    const std::size_t p =
        (static_cast<std::size_t>(k) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(i)) * 3;
    return {rgb[p], rgb[p + 1], rgb[p + 2]};
  }
};

Cut cut(const SectionView& view) {
  Cut out{view, {}};
  out.rgb.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) * 3);
  SectionScratch scratch;
  for (int i = 0; i < view.width; ++i) draw_section_column(world(), view, i, scratch, out.rgb);
  return out;
}

TEST(Section, HasSkyAboveTheGroundSeaBelowZeroAndRockUnderBoth) {
  constexpr int kColumns = test::rounds(600);
  const Cut c = cut({{-30'000, 0}, {30'000, 4000}, -900, 2600, kColumns, 500});
  ColumnBlock block;
  int sea = 0;
  int land = 0;
  for (int i = 0; i < kColumns; i += 3) {
    const double along = (i + 0.5) / kColumns;
    const auto x = static_cast<std::int64_t>(std::floor(-30'000 + 60'000 * along));
    const auto z = static_cast<std::int64_t>(std::floor(4000 * along));
    world().columns({x, z, 1, 1, 1, 1.0}, block);
    const double height = static_cast<double>(block.height_m[0]);
    const auto above = c.at(i, std::max(height, 0.0) + 60);
    EXPECT_GT(above[2], 170) << "sky at " << i;
    EXPECT_GT(above[2], above[0]) << "sky at " << i;
    const auto below = c.at(i, height - 60);
    EXPECT_LT(below[2], below[0] + 5) << "rock at " << i;
    if (height < -80) {
      const auto water = c.at(i, -40);
      EXPECT_GT(water[2], water[0] + 30) << "sea at " << i;
      ++sea;
    } else if (height > 0) {
      ++land;
    }
  }
  EXPECT_GT(sea, test::rounds(10));
  EXPECT_GT(land, test::rounds(10));
}

TEST(Section, ReachesAsHighAndLowAsTheGround) {
  SectionScratch scratch;
  const glm::dvec2 heights = section_heights(world(), {{0, 0}, {8000, 0}, 0, 0, 8, 8}, 200, scratch);
  ColumnBlock block;
  world().columns({4000, 0, 1, 1, 1, 1.0}, block);
  EXPECT_LT(heights.x, heights.y);
  EXPECT_LE(heights.x, static_cast<double>(block.height_m[0]) + 25);
  EXPECT_GE(heights.y, static_cast<double>(block.height_m[0]) - 25);
}

}  // namespace
}  // namespace talus
