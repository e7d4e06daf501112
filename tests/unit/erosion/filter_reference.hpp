// The erosion filter once more, as its formulas read: one point, scalar, double precision, libm. The oracle of
// filter_test.
#pragma once

#include "core/erosion/filter.hpp"

namespace talus::test {

struct ErosionPoint {
  double height_m = 0, slope_x = 0, slope_z = 0, ridge = 0;
};

/// What erode() ought to give at (x, z), in metres, for this slope, fade target and strength.
ErosionPoint erode_reference(const ErosionControls& controls, double x_m, double z_m, double slope_x, double slope_z,
                             double fade_target, double strength);

/// The same by the frequency method.
ErosionPoint erode_by_frequency_reference(const ErosionControls& controls, double x_m, double z_m, double slope_x,
                                          double slope_z, double fade_target, double strength);

}  // namespace talus::test
