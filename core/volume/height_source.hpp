// Where the volume takes the heights of the surface, and its beds, from: the world function, or a cliff that a test
// makes up.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/grid/column_grid.hpp"

namespace talus {

class HeightSource {
 public:
  virtual ~HeightSource() = default;
  /// A number that no two surfaces share: remembered tiles are told apart by it.
  virtual std::uint64_t identity() const = 0;
  virtual double voxel_m() const = 0;
  /// The surface's height at every column of `grid`, in rows of row_stride(grid) floats. Pure; valid until the next
  /// call.
  virtual std::span<const float> heights(const ColumnGrid& grid) = 0;
  /// Height of the base of a hard bed over a soft one under a place, near `height_m`; nothing where there is none.
  /// Pure.
  virtual std::optional<float> ceiling_near(double x_m, double z_m, float height_m) = 0;
};

}  // namespace talus
