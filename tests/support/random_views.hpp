// Views close to the ground of a world, of every kind of ground that a surface can be difficult at: high ground, the
// sea, walls that beds jut out of, and what is carved there; half of them around the origin, half around 10^9 m.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "core/mesh/build_chunk.hpp"
#include "core/world/volume_scratch.hpp"
#include "protocol/interest_area.hpp"
#include "tests/support/random.hpp"

namespace talus::test {

/// What a view stands at. Of the last two kinds it has what they are named by, or else the steepest ground found.
enum class Ground : std::uint8_t { kHigh, kShore, kAny, kCliff, kAlcove, kArch };
inline constexpr int kGrounds = 6;

class RandomViews {
 public:
  RandomViews(const WorldFunction& world, Random& random) : world_(world), random_(random) {}

  static Ground ground_of(int number) { return static_cast<Ground>(number % kGrounds); }
  static bool is_far(int number) { return number / kGrounds % 2 == 1; }

  protocol::View view(int number) {
    reach_m_ = is_far(number) ? 1.0e9 : 2.0e4;
    const glm::dvec2 at = place(ground_of(number));
    column(at);
    protocol::View view;
    const bool is_wall = ground_of(number) >= Ground::kCliff;
    view.position = {at.x + random_.unit(),
                     height_m() + (is_wall ? random_.real(-20.0, 25.0) : random_.real(-25.0, 60.0)),
                     at.y + random_.unit()};
    view.near_m = 56.0;
    view.far_m = random_.real(70.0, 130.0);
    return view;
  }

 private:
  glm::dvec2 anywhere() {
    return {std::floor(random_.real(-reach_m_, reach_m_)), std::floor(random_.real(-reach_m_, reach_m_))};
  }
  void column(const glm::dvec2& at) {
    world_.columns({static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y), 1, 1, 1, world_.voxel_m()},
                   block_);
  }
  double height_m() const { return static_cast<double>(block_.height_m[0]); }

  glm::dvec2 place(Ground ground) {
    switch (ground) {
      case Ground::kHigh:
        return best_of(12, [](double height_m) { return height_m; });
      case Ground::kShore:
        return best_of(12, [](double height_m) { return -std::abs(height_m); });
      case Ground::kAny:
        return anywhere();
      case Ground::kCliff:
        return cliff();
      case Ground::kAlcove:
        return carved(CarveKind::kAlcoves);
      case Ground::kArch:
        return carved(CarveKind::kArches);
    }
    return {};
  }

  template <class Merit>
  glm::dvec2 best_of(int tries, Merit merit) {
    glm::dvec2 out{};
    double best = -1.0e9;
    for (int i = 0; i < tries; ++i) {
      const glm::dvec2 at = anywhere();
      column(at);
      if (merit(height_m()) <= best) continue;
      best = merit(height_m());
      out = at;
    }
    return out;
  }

  /// A shore between a place on land and one in the sea that chance picks: halving finds it.
  std::optional<glm::dvec2> shore() {
    glm::dvec2 land = anywhere();
    column(land);
    const bool begins_on_land = height_m() >= 0;
    constexpr double kSide_m = 4000;
    glm::dvec2 sea = land + glm::dvec2(random_.real(-kSide_m, kSide_m), random_.real(-kSide_m, kSide_m));
    column(sea);
    if ((height_m() >= 0) == begins_on_land) return std::nullopt;
    if (!begins_on_land) std::swap(land, sea);
    while (std::abs(land.x - sea.x) > 1 || std::abs(land.y - sea.y) > 1) {
      const glm::dvec2 middle = (land + sea) * 0.5;
      column(middle);
      (height_m() >= 0 ? land : sea) = middle;
    }
    return glm::dvec2(std::floor(land.x), std::floor(land.y));
  }

  /// A shore below a wall, the highest of some.
  glm::dvec2 cliff() {
    constexpr int kTries = 40;
    constexpr float kHigh_m = 25;
    glm::dvec2 out{};
    float best = -1;
    for (int i = 0; i < kTries && best < kHigh_m; ++i) {
      const auto at = shore();
      if (!at) continue;
      column(*at);
      if (block_.cliff_m[0] <= best) continue;
      best = block_.cliff_m[0];
      out = *at;
    }
    return out;
  }

  /// Where a sphere of that kind is, around one of some cliffs; else the last of them.
  glm::dvec2 carved(CarveKind kind) {
    constexpr int kCliffs = 4;
    constexpr std::int64_t kAround = 96;
    glm::dvec2 at{};
    for (int i = 0; i < kCliffs; ++i) {
      at = cliff();
      // Columns 8 m apart are cheap, and feel nearly every sphere.
      constexpr std::int64_t kStep = 8;
      constexpr int kEdge = 2 * kAround / kStep + 1;
      world_.columns({static_cast<std::int64_t>(at.x) - kAround, static_cast<std::int64_t>(at.y) - kAround, kStep,
                      kEdge, kEdge, world_.voxel_m()},
                     block_);
      world_.volume(block_, scratch_);
      for (const CarveSphere& sphere : block_.spheres) {
        if (sphere.kind == kind) return {std::floor(sphere.x_m), std::floor(sphere.z_m)};
      }
    }
    return at;
  }

  const WorldFunction& world_;
  Random& random_;
  double reach_m_ = 0;
  ColumnBlock block_;
  VolumeScratch scratch_;
};

}  // namespace talus::test
