#include "core/strata/dominant_rock.hpp"

#include <algorithm>
#include <array>

namespace talus {
namespace {

/// Slices of one metre; the first and last stand for what lies beyond the stack.
constexpr int kSlices = static_cast<int>(kStackDepth);

using Amounts = std::array<double, kMaterials.size()>;

/// Metres of every rock above each whole metre of depth.
std::vector<Amounts> amounts_above(const LayerSet& set) {
  std::vector<Amounts> out{Amounts{}};
  Amounts sum{};
  int index = 0;
  for (int slice = 0; slice < kSlices; ++slice) {
    const auto top = static_cast<float>(slice);
    for (;; ++index) {
      const float from = std::max(top, set.top_m(index));
      const float to = std::min(top + 1.0f, set.top_m(index + 1));
      const Layer& layer = set.layer(index);
      float below = 0;
      for (std::size_t n = 0; n < kRocksPerLayer; ++n) {
        sum[static_cast<std::size_t>(layer.rocks[n])] +=
            static_cast<double>(layer.cumulative[n] - below) * static_cast<double>(std::max(to - from, 0.0f));
        below = layer.cumulative[n];
      }
      if (index + 1 == kLayers || set.top_m(index + 1) >= top + 1.0f) break;
    }
    out.push_back(sum);
  }
  return out;
}

}  // namespace

void DominantRock::add(const LayerSet& set) {
  const std::vector<Amounts> above = amounts_above(set);
  std::vector<std::size_t> rocks;  // that the set holds at all: a third of the materials
  for (std::size_t n = 0; n < above.back().size(); ++n) {
    if (above.back()[n] > 0) rocks.push_back(n);
  }
  for (int span = 0; span < kSpans; ++span) {
    const int half = static_cast<int>(kSpanLow_m / 2) << span;
    for (int slice = 0; slice < kSlices; ++slice) {
      const Amounts& low = above[static_cast<std::size_t>(std::max(slice - half, 0))];
      const Amounts& high = above[static_cast<std::size_t>(std::min(slice + half, kSlices))];
      std::size_t most = 0;
      double most_m = 0;
      for (const std::size_t n : rocks) {
        const double metres = high[n] - low[n];
        if (!(metres > most_m)) continue;
        most = n;
        most_m = metres;
      }
      rocks_.push_back(static_cast<Material>(most));
    }
  }
}

Material DominantRock::at(int set, float depth_m, double span_m) const {
  int span = 0;
  while (span + 1 < kSpans && kSpanLow_m * static_cast<double>(2 << span) <= span_m) ++span;
  const int slice = std::clamp(static_cast<int>(depth_m), 0, kSlices - 1);
  return rocks_[static_cast<std::size_t>((set * kSpans + span) * kSlices + slice)];
}

}  // namespace talus
