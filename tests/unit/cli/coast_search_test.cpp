#include "client_sample/cli/coast_search.hpp"

#include <gtest/gtest.h>

namespace talus::cli {
namespace {

TEST(CoastSearch, LooksIntoTheSameShoresEveryTimeAndIntoNoneWhereThereIsNoSea) {
  const WorldFunction world{Manifest()};
  const SurveyGrid grid = survey_grid(world, {{4800, 39'296}, 2000});
  const CoastFigures once = search_coast(world, grid, 2);
  const CoastFigures again = search_coast(world, grid, 2);
  EXPECT_GT(once.shore_km, 0.2);
  EXPECT_GT(once.cliff_share, 0.2) << "a coast of cliffs";
  EXPECT_GT(once.overhang_m2_per_m, 0);
  EXPECT_EQ(once.shore_km, again.shore_km);
  EXPECT_EQ(once.arches, again.arches);
  EXPECT_EQ(once.caves, again.caves);
  EXPECT_EQ(once.overhang_m2_per_m, again.overhang_m2_per_m);
  EXPECT_EQ(once.loose, again.loose);
  EXPECT_EQ(once.loose > 0, once.loose_m3 > 0);

  SurveyGrid inland = grid;
  for (float& height : inland.height_m) height = 100;
  EXPECT_EQ(search_coast(world, inland, 2).shore_km, 0);
}

}  // namespace
}  // namespace talus::cli
