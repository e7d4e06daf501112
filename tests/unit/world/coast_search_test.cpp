// What a coast must offer, found by a search that anyone can repeat.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/world/world_function.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSearchSeed = 1848;

/// Looks along a profile of 1 m steps for a wall: from within 5 m of the sea up by 30 m with slope 1.5 throughout.
bool has_wall(const ColumnBlock& block, int row) {
  const float* h = &block.height_m[static_cast<std::size_t>(row) * block.stride];
  const int width = block.grid.width;
  for (int i = 0; i < width; ++i) {
    if (std::abs(h[i]) > 5.0f) continue;
    for (const int way : {-1, 1}) {
      int at = i;
      while (at + way >= 0 && at + way < width && h[at + way] - h[at] >= 1.5f) at += way;
      if (h[at] - h[i] >= 30.0f) return true;
    }
  }
  return false;
}

/// Whether a walk from the sea meets 25 m of sand that rises gently.
bool has_beach(const ColumnBlock& block, int row) {
  const std::size_t at = static_cast<std::size_t>(row) * block.stride;
  int run = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(block.grid.width); ++i) {
    const float h = block.height_m[at + i];
    const bool is_sand =
        h > -0.5f && h < 4.0f && block.beach[at + i] > 0.8f && std::abs(h - block.height_m[at + i - 1]) < 0.25f;
    run = is_sand ? run + 1 : 0;
    if (run >= 25) return true;
  }
  return false;
}

TEST(CoastSearch, FindsBeachesAndWallsThatRiseThirtyMetresStraightFromTheSea) {
  const WorldFunction world{Manifest()};
  test::Random random(kSearchSeed);
  ColumnBlock rough;
  ColumnBlock fine;
  int shores = 0;
  int walls = 0;
  int beaches = 0;
  for (int round = 0; round < test::rounds(400); ++round) {
    // A row of 160 columns 64 m apart; every shore on it is looked at closely.
    const std::int64_t x = random.whole(-40'000'000, 40'000'000);
    const std::int64_t z = random.whole(-40'000'000, 40'000'000);
    world.columns({x, z, 64, 160, 1, 1.0}, rough);
    for (int i = 1; i < 160; ++i) {
      const float here = rough.height_m[static_cast<std::size_t>(i)];
      const float before = rough.height_m[static_cast<std::size_t>(i) - 1];
      if ((here < 0) == (before < 0)) continue;
      world.columns({x + 64 * i - 112, z, 1, 160, 1, 1.0}, fine);
      ++shores;
      walls += has_wall(fine, 0) ? 1 : 0;
      beaches += has_beach(fine, 0) ? 1 : 0;
    }
  }
  EXPECT_GT(shores, test::rounds(100)) << "seed " << kSearchSeed;
  EXPECT_GT(walls, shores / 10) << "of " << shores << " shores, seed " << kSearchSeed;
  EXPECT_GT(beaches, shores / 20) << "of " << shores << " shores, seed " << kSearchSeed;
  RecordProperty("shores", shores);
  RecordProperty("walls", walls);
  RecordProperty("beaches", beaches);
}

}  // namespace
}  // namespace talus
