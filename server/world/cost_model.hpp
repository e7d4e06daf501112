// What a chunk is expected to cost before it is begun, learnt from those before it. Any thread; relaxed: a lost update
// costs a little precision.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace talus::server {

/// What is known of a chunk that bounds did not rule out.
enum class CostClass : std::uint8_t {
  kFreshGround,  ///< nobody has looked at its square: columns, and perhaps a surface
  kKnownGround,  ///< its square's heights meet it: a surface, its columns perhaps at hand
  kMapTile,
  kEnd
};

class CostModel {
 public:
  double predicted_s(CostClass of) const { return mean_s_[index(of)].load(std::memory_order_relaxed); }
  void learn(CostClass of, double took_s) {
    std::atomic<double>& mean = mean_s_[index(of)];
    const double before = mean.load(std::memory_order_relaxed);
    mean.store(before + kWeight * (took_s - before), std::memory_order_relaxed);
  }

 private:
  static std::size_t index(CostClass of) { return static_cast<std::size_t>(of); }
  /// Follows a change of ground within some sixty chunks, and no single one.
  static constexpr double kWeight = 1.0 / 32;
  /// Before anything is learnt: columns 0.4 ms, extraction and encoding 1.5 ms; 65,536 columns of a tile, and its PNG.
  std::array<std::atomic<double>, static_cast<std::size_t>(CostClass::kEnd)> mean_s_{0.001, 0.0015, 0.020};
};

}  // namespace talus::server
