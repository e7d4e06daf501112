#include "core/volume/arch.hpp"

#include <algorithm>
#include <array>

namespace talus {
namespace {

/// Directions looked in: straight inland, and 17, 34 and 51 degrees to either side.
constexpr std::array<glm::vec2, 7> kTurns{{{1.0f, 0.0f},
                                           {0.95630f, 0.29237f},
                                           {0.95630f, -0.29237f},
                                           {0.82904f, 0.55919f},
                                           {0.82904f, -0.55919f},
                                           {0.62932f, 0.77715f},
                                           {0.62932f, -0.77715f}}};
constexpr float kLookStep_m = 3.0f;
constexpr float kLookFrom_m = 4.0f;
constexpr float kLengthMin_m = 7.0f;
constexpr float kCrestMin_m = 10.0f;
/// Water again: no higher than this above the seed.
constexpr float kFarSide_m = 1.0f;
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
  // Both legs must stand: an arch that only cuts a corner leaves none.
  const auto stands = [&](const ArchWay& way) {
    const glm::dvec2 middle = ahead(seed_m, way.along, 0.5f * way.length_m);
    const glm::vec2 aside{-way.along.y, way.along.x};
    const float leg_m = seed_y_m + kLegHeight * way.radius_m * pass.stretch;
    const float off_m = way.radius_m + kLegDistance_m;
    return height(ahead(middle, aside, off_m)) >= leg_m && height(ahead(middle, aside, -off_m)) >= leg_m;
  };
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
      const ArchWay way{along, s, radius_m};
      if (radius_m >= 0.58f * pass.radius_low_m && stands(way)) shortest = way;
      break;
    }
  }
  return shortest;
}

}  // namespace talus
