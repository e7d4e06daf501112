#include "core/strata/layer_set.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"

namespace talus {
namespace {

constexpr int kSlices = 4096;
constexpr float kSlicesPerMetre = static_cast<float>(kSlices) / kStackDepth;

/// A group of layers of one character.
struct Formation {
  Material hard, soft;  ///< beds and the partings between them
  float bed_low_m, bed_high_m;
  float parting_low_m, parting_high_m;
  float whole_low_m, whole_high_m;  ///< thickness of the formation
  float mixed;                      ///< share of the other rock inside a layer
};

constexpr std::array<Formation, 6> kFormations{{
    {Material::kLimestone, Material::kShale, 5.0f, 16.0f, 0.4f, 1.4f, 45.0f, 120.0f, 0.06f},
    {Material::kRedSandstone, Material::kMudstone, 2.0f, 9.0f, 0.8f, 3.0f, 40.0f, 110.0f, 0.15f},
    {Material::kMudstone, Material::kShale, 3.0f, 9.0f, 2.0f, 6.0f, 35.0f, 95.0f, 0.20f},
    {Material::kSandstone, Material::kMarl, 4.0f, 14.0f, 0.6f, 2.5f, 40.0f, 120.0f, 0.12f},
    {Material::kLimestone, Material::kMarl, 0.8f, 2.6f, 0.6f, 2.2f, 25.0f, 70.0f, 0.10f},
    {Material::kBasalt, Material::kGranite, 10.0f, 30.0f, 6.0f, 14.0f, 50.0f, 140.0f, 0.10f},
}};

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

Layer layer_of(Material main, Material other, float mixed) {
  return {hardness_of(main) * (1 - mixed) + hardness_of(other) * mixed, {main, other}, {1 - mixed, 1.0f}};
}

}  // namespace

LayerSet::LayerSet(std::uint64_t seed) : start_(kSlices) {
  Draw draw(seed);
  std::vector<double> thickness;
  std::size_t last = kFormations.size();
  while (layers_.size() < kLayers) {
    auto pick = static_cast<std::size_t>(draw.between(0, static_cast<float>(kFormations.size())));
    if (pick == last) pick = (pick + 1) % kFormations.size();
    last = pick;
    const Formation& f = kFormations[pick];
    float left = draw.between(f.whole_low_m, f.whole_high_m);
    for (bool bed = true; left > 0 && layers_.size() < kLayers; bed = !bed) {
      const float t = bed ? draw.between(f.bed_low_m, f.bed_high_m) : draw.between(f.parting_low_m, f.parting_high_m);
      layers_.push_back(bed ? layer_of(f.hard, f.soft, f.mixed) : layer_of(f.soft, f.hard, f.mixed));
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
  for (int slice = 0; slice < kSlices; ++slice) {
    const float depth = static_cast<float>(slice) / kSlicesPerMetre;
    while (index + 1 < kLayers && tops_[static_cast<std::size_t>(index) + 1] <= depth) ++index;
    start_[static_cast<std::size_t>(slice)] = static_cast<std::uint16_t>(index);
  }
}

int LayerSet::index_at(float depth_m) const {
  const float depth = std::clamp(depth_m, 0.0f, kStackDepth);
  const int slice = std::min(static_cast<int>(depth * kSlicesPerMetre), kSlices - 1);
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
