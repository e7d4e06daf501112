#include "core/strata/layer_set.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"

namespace talus {
namespace {

constexpr int kStartSlices = 4096;
constexpr float kStartSlicesPerMetre = static_cast<float>(kStartSlices) / kStackDepth;

/// Uniform numbers from a seed, one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  float between(float low, float high) {
    return low + (high - low) * (static_cast<float>(mix64(seed_, next_++) >> 40) * 0x1p-24f);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

/// How much more often a set has the formations that it likes best than those that it likes least.
constexpr float kPreference = 12.0f;

/// Which formation comes next: each by the set's weight for it, and none twice in a row.
class FormationDraw {
 public:
  explicit FormationDraw(Draw& draw) : draw_(draw) {
    for (std::size_t n = 0; n < formations().size(); ++n) {
      const float liking = draw.between(0, 1);
      sum_ += 1.0f + (kPreference - 1.0f) * liking * liking * liking;
      cumulative_.push_back(sum_);
    }
  }

  const Formation& next() {
    std::size_t pick = last_;
    while (pick == last_) {
      const auto at = std::ranges::upper_bound(cumulative_, draw_.between(0, sum_));
      pick = std::min(static_cast<std::size_t>(at - cumulative_.begin()), cumulative_.size() - 1);
    }
    last_ = pick;
    return formations()[pick];
  }

 private:
  Draw& draw_;
  std::vector<float> cumulative_;
  float sum_ = 0;
  std::size_t last_ = formations().size();
};

/// A layer of a mixture whose shares chance has shifted by up to half, so that no two layers are alike.
Layer layer_of(const Mixture& mixture, Draw& draw) {
  Layer out;
  float sum = 0;
  for (std::size_t n = 0; n < kRocksPerLayer; ++n) {
    sum += mixture[n].share * draw.between(0.5f, 1.5f);
    out.rocks[n] = mixture[n].rock;
    out.cumulative[n] = sum;
  }
  float below = 0;
  for (std::size_t n = 0; n < kRocksPerLayer; ++n) {
    out.cumulative[n] = n + 1 < kRocksPerLayer ? out.cumulative[n] / sum : 1.0f;
    out.hardness += hardness_of(out.rocks[n]) * (out.cumulative[n] - below);
    below = out.cumulative[n];
  }
  return out;
}

}  // namespace

LayerSet::LayerSet(std::uint64_t seed) : start_(kStartSlices) {
  Draw draw(seed);
  std::vector<double> thickness;
  FormationDraw formation(draw);
  while (layers_.size() < kLayers) {
    const Formation& f = formation.next();
    float left = draw.between(f.whole_low_m, f.whole_high_m);
    for (bool bed = true; left > 0 && layers_.size() < kLayers; bed = !bed) {
      const float t = bed ? draw.between(f.bed_low_m, f.bed_high_m) : draw.between(f.parting_low_m, f.parting_high_m);
      layers_.push_back(layer_of(bed ? f.beds : f.partings, draw));
      thickness.push_back(static_cast<double>(t));
      left -= t;
    }
  }
  // The stack as drawn is of some other height: what counts is that it ends where every stack ends.
  double total = 0;
  for (const double t : thickness) total += t;
  const double scale = static_cast<double>(kStackDepth) / total;
  double sum = 0;
  for (const double t : thickness) {
    tops_.push_back(static_cast<float>(sum * scale));
    sum += t;
  }
  tops_.push_back(kStackDepth);

  int index = 0;
  for (int slice = 0; slice < kStartSlices; ++slice) {
    const float depth = static_cast<float>(slice) / kStartSlicesPerMetre;
    while (index + 1 < kLayers && tops_[static_cast<std::size_t>(index) + 1] <= depth) ++index;
    start_[static_cast<std::size_t>(slice)] = static_cast<std::uint16_t>(index);
  }
}

int LayerSet::index_at(float depth_m) const {
  const float depth = std::clamp(depth_m, 0.0f, kStackDepth);
  const int slice = std::min(static_cast<int>(depth * kStartSlicesPerMetre), kStartSlices - 1);
  int index = start_[static_cast<std::size_t>(slice)];
  // A slice is 1.25 m and holds the tops of a few layers at most.
  while (index + 1 < kLayers && tops_[static_cast<std::size_t>(index) + 1] <= depth) ++index;
  return index;
}

Material LayerSet::rock_at(int index, float share) const {
  const Layer& layer = layers_[static_cast<std::size_t>(index)];
  const auto at = std::ranges::upper_bound(layer.cumulative, share);
  return layer.rocks[std::min(static_cast<std::size_t>(at - layer.cumulative.begin()), kRocksPerLayer - 1)];
}

}  // namespace talus
