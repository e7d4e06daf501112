#include "core/world/density.hpp"

#include "core/base/check.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/world/density.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One row: (y - height) * steepness for `count` columns, rounded up to whole vectors.
void density_row(float y_m, const float* HWY_RESTRICT height, const float* HWY_RESTRICT steepness, std::size_t count,
                 float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const auto y = hn::Set(d, y_m);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto above = hn::Sub(y, hn::LoadU(d, height + i));
    hn::StoreU(hn::Mul(above, hn::LoadU(d, steepness + i)), d, out + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(density_row);

namespace {

/// Rows lie closer than whole vectors: each row's last vector runs into the next row, which is written after it.
std::size_t packed_stride(const ColumnGrid& grid) {
  return (static_cast<std::size_t>(grid.width) + 3) / 4 * 4;
}

}  // namespace

std::size_t density_floats(const ColumnGrid& grid, int layers) {
  return packed_stride(grid) * static_cast<std::size_t>(grid.depth) * static_cast<std::size_t>(layers) + kRowPadding;
}

DensityBox sample_density(const ColumnBlock& columns, std::int64_t y_voxel, int layers, std::span<float> samples) {
  const ColumnGrid& grid = columns.grid;
  TALUS_CHECK(samples.size() >= density_floats(grid, layers));
  const DensityBox box{y_voxel, layers, packed_stride(grid), static_cast<std::size_t>(grid.depth)};
  const auto row = HWY_DYNAMIC_DISPATCH(density_row);
  float* out = samples.data();
  for (int j = 0; j < layers; ++j) {
    const auto y_m = static_cast<float>(static_cast<double>(y_voxel + j * grid.step_voxel) * grid.voxel_m);
    for (std::size_t k = 0; k < box.depth; ++k, out += box.stride) {
      row(y_m, &columns.height_m[k * columns.stride], &columns.steepness[k * columns.stride],
          static_cast<std::size_t>(grid.width), out);
    }
  }
  return box;
}

}  // namespace talus
#endif  // HWY_ONCE
