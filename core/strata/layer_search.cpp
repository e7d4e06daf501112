#include "core/strata/layer_search.hpp"

#include <algorithm>
#include <array>

#include "core/base/check.hpp"

#ifndef TALUS_LAYER_SEARCH_CONSTANTS
#define TALUS_LAYER_SEARCH_CONSTANTS
namespace talus {

/// Slices of 0.3125 m.
inline constexpr int kSearchSlices = 16384;
inline constexpr float kSearchSlicesPerMetre = static_cast<float>(kSearchSlices) / kStackDepth;

}  // namespace talus
#endif  // TALUS_LAYER_SEARCH_CONSTANTS

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/strata/layer_search.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// `count` is a whole number of vectors of any target.
void find_layers(const float* tops, const std::int32_t* begins, const float* depths, std::size_t count,
                 std::int32_t* layers) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto depth = hn::Min(hn::Max(hn::LoadU(d, depths + i), hn::Zero(d)), hn::Set(d, kStackDepth));
    const auto slice =
        hn::Min(hn::ConvertTo(di, hn::Mul(depth, hn::Set(d, kSearchSlicesPerMetre))), hn::Set(di, kSearchSlices - 1));
    auto layer = hn::GatherIndex(di, begins, slice);
    for (;;) {
      const auto below = hn::Le(hn::GatherIndex(d, tops + 1, layer), depth);
      if (hn::AllFalse(d, below)) break;
      layer = hn::Sub(layer, hn::VecFromMask(di, hn::RebindMask(di, below)));
    }
    hn::StoreU(layer, di, layers + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(find_layers);

LayerSearch::LayerSearch(const LayerSet& set) {
  for (int i = 0; i < kLayers; ++i) tops_.push_back(set.top_m(i));
  // The last layer goes on for ever.
  tops_.push_back(2 * kStackDepth);
  for (int slice = 0; slice < kSearchSlices; ++slice) {
    begins_.push_back(set.index_at(static_cast<float>(slice) / kSearchSlicesPerMetre));
  }
}

void LayerSearch::find(std::span<const float> depths_m, std::span<std::int32_t> layers) const {
  TALUS_CHECK(depths_m.size() == layers.size());
  constexpr std::size_t kVector = 16;
  const std::size_t whole = depths_m.size() / kVector * kVector;
  const auto find = HWY_DYNAMIC_DISPATCH(find_layers);
  find(tops_.data(), begins_.data(), depths_m.data(), whole, layers.data());
  if (whole == depths_m.size()) return;
  std::array<float, kVector> depths{};
  std::array<std::int32_t, kVector> found{};
  std::ranges::copy(depths_m.subspan(whole), depths.begin());
  find(tops_.data(), begins_.data(), depths.data(), kVector, found.data());
  std::copy_n(found.begin(), depths_m.size() - whole, layers.begin() + static_cast<std::ptrdiff_t>(whole));
}

}  // namespace talus
#endif  // HWY_ONCE
