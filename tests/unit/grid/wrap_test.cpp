#include "core/grid/wrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/grid/axis.hpp"

namespace talus {
namespace {

TEST(Wrap, ReducesIndicesOfEitherSignAndLeavesThemAloneWithoutAPeriod) {
  static_assert(wrapped(7, 5) == 2 && wrapped(-1, 5) == 4 && wrapped(-10, 5) == 0 && wrapped(5, 5) == 0);
  static_assert(wrapped(-123, 0) == -123);
  EXPECT_EQ(cells_around(16'384, 131'072), 8);
  EXPECT_EQ(cells_around(26'000, 131'072), 5);
  EXPECT_EQ(cells_around(500'000, 131'072), 1);
  EXPECT_EQ(cells_around(100, 0), 0);
  EXPECT_EQ(fitted_cell_m(16'384, 131'072), 16'384);
  EXPECT_EQ(fitted_cell_m(26'000, 131'072), 131'072.0 / 5);
  EXPECT_EQ(fitted_cell_m(26'000, 0), 26'000);
}

TEST(Wrap, MakesAnAxisRepeatBitForBitAndMeetItselfAtTheSeam) {
  ColumnGrid grid;
  grid.wrap_voxel = 131'072;
  for (const double cell_m : {26'000.0, 3'200.0, 60.0, 7.77}) {
    const Octave octave = octave_on(grid, 1 / cell_m, 42);
    EXPECT_NEAR(octave.cells_per_m * cell_m, 1, 0.05);
    Axis here;
    Axis there;
    for (const std::int64_t start : {-40LL, 131'000LL, 12'345LL}) {
      split_axis(octave, 0, start, 3, 1, 60, -1, 4, here);
      split_axis(octave, 0, start - 5 * grid.wrap_voxel, 3, 1, 60, -1, 4, there);
      EXPECT_TRUE(std::equal(here.fraction.begin(), here.fraction.begin() + 60, there.fraction.begin()));
      for (std::size_t t = 0; t < 4; ++t) {
        const auto& row = here.cell_hash[t];
        EXPECT_TRUE(std::equal(row.begin(), row.begin() + 60, there.cell_hash[t].begin())) << cell_m << ' ' << start;
      }
    }
    // One voxel to the left of the seam lies one voxel before its first cell: in its neighbour, or in itself.
    split_axis(octave, 0, -1, 1, 1, 2, -1, 4, here);
    const double step = static_cast<double>(here.fraction[1]) - static_cast<double>(here.fraction[0]);
    EXPECT_NEAR(step - std::floor(step), octave.cells_per_m - std::floor(octave.cells_per_m), 1e-6);
    if (step > 0) {
      for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(here.cell_hash[t][0], here.cell_hash[t][1]);
    } else {
      for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(here.cell_hash[t + 1][0], here.cell_hash[t][1]);
    }
  }
}

TEST(Wrap, LeavesTheOtherAxisEndless) {
  ColumnGrid grid;
  grid.wrap_voxel = 131'072;
  const Octave octave = octave_on(grid, 1.0 / 3'200, 42);
  Axis here;
  Axis there;
  split_axis(octave, 1, 1'000, 1, 1, 16, 0, 2, here);
  split_axis(octave, 1, 1'000 + grid.wrap_voxel, 1, 1, 16, 0, 2, there);
  EXPECT_NE(here.cell_hash[0][0], there.cell_hash[0][0]);
}

}  // namespace
}  // namespace talus
