#include "core/volume/arch.hpp"

#include <algorithm>
#include <array>

namespace talus {
namespace {

/// Directions looked in: straight inland, and 17 and 34 degrees to either side.
constexpr std::array<glm::vec2, 5> kTurns{
    {{1.0f, 0.0f}, {0.95630f, 0.29237f}, {0.95630f, -0.29237f}, {0.82904f, 0.55919f}, {0.82904f, -0.55919f}}};
constexpr float kLookStep_m = 3.0f;
constexpr float kLookFrom_m = 4.0f;
constexpr float kLengthMin_m = 7.0f;
constexpr float kCrestMin_m = 10.0f;
/// Water again: no higher than this above the seed.
constexpr float kFarSide_m = 0.5f;
/// Rock above an arch's ceiling, in radii, and its legs' height and distance.
constexpr float kClearance = 1.35f;
constexpr float kLegHeight = 0.9f;
constexpr float kLegDistance_m = 5.0f;
constexpr float kWidth = 0.45f;
constexpr float kWidthMore_m = 2.0f;

glm::dvec2 ahead(glm::dvec2 from, glm::vec2 along, float by_m) {
  return {from.x + static_cast<double>(along.x * by_m), from.y + static_cast<double>(along.y * by_m)};
}

}  // namespace

std::optional<ArchWay> find_arch(const CarveControls& controls, Relief& relief, glm::dvec2 seed_m, float seed_y_m,
                                 glm::vec2 inland) {
  const CarvePass& pass = controls.pass(CarveKind::kArches);
  const auto height = [&](glm::dvec2 at) { return relief.height_at(at.x, at.y); };
  std::optional<ArchWay> shortest;
  const int looks = static_cast<int>((controls.arch_span_m - kLookFrom_m) / kLookStep_m);
  for (const glm::vec2& turn : kTurns) {
    const glm::vec2 along{inland.x * turn.x - inland.y * turn.y, inland.x * turn.y + inland.y * turn.x};
    float crest_m = seed_y_m;
    for (int look = 0; look <= looks; ++look) {
      const float s = kLookFrom_m + static_cast<float>(look) * kLookStep_m;
      if (shortest && s >= shortest->length_m) break;
      const float h = height(ahead(seed_m, along, s));
      crest_m = std::max(crest_m, h);
      if (h >= seed_y_m + kFarSide_m) continue;
      if (s < kLengthMin_m || crest_m < seed_y_m + kCrestMin_m) break;
      const float under_roof_m = (crest_m - pass.roof_m - seed_y_m) / (kClearance * pass.stretch);
      const float radius_m = std::min({pass.radius_high_m, under_roof_m, kWidth * s + kWidthMore_m});
      if (radius_m >= 0.58f * pass.radius_low_m) shortest = ArchWay{along, s, radius_m};
      break;
    }
  }
  if (!shortest) return std::nullopt;
  const glm::dvec2 middle = ahead(seed_m, shortest->along, 0.5f * shortest->length_m);
  const glm::vec2 aside{-shortest->along.y, shortest->along.x};
  const float leg_m = seed_y_m + kLegHeight * shortest->radius_m * pass.stretch;
  for (const float side : {1.0f, -1.0f}) {
    if (height(ahead(middle, aside, side * (shortest->radius_m + kLegDistance_m))) < leg_m) return std::nullopt;
  }
  return shortest;
}

}  // namespace talus
