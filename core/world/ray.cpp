#include "core/world/ray.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/base/check.hpp"

namespace talus {
namespace {

/// Cells along a brick's edge. Rows are evaluated in vectors of 16 columns: 15 cells would waste none of them along x,
/// but most rows; 8 cells are quickest for rays that do not run along an axis.
constexpr int kBrickCells = 8;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Steps through a lattice of boxes along a ray, in the ray's own parameter. Amanatides and Woo, "A fast voxel
/// traversal algorithm for ray tracing", 1987.
template <std::size_t kAxes>
class Walk {
 public:
  /// `from` and `direction` in boxes.
  Walk(const std::array<double, kAxes>& from, const std::array<double, kAxes>& direction, double at) : at_(at) {
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double place = from[i] + direction[i] * at;
      box[i] = static_cast<std::int64_t>(std::floor(place));
      step_[i] = direction[i] > 0 ? 1 : -1;
      length_[i] = direction[i] != 0 ? 1.0 / std::abs(direction[i]) : kNever;
      const double border = static_cast<double>(box[i] + (direction[i] > 0 ? 1 : 0));
      next_[i] = direction[i] != 0 ? (border - from[i]) / direction[i] : kNever;
    }
  }

  double enter() const { return at_; }
  double leave() const { return *std::ranges::min_element(next_); }
  void advance() {
    const auto axis = static_cast<std::size_t>(std::ranges::min_element(next_) - next_.begin());
    at_ = next_[axis];
    box[axis] += step_[axis];
    next_[axis] += length_[axis];
  }

  std::array<std::int64_t, kAxes> box{};

 private:
  double at_;
  std::array<std::int64_t, kAxes> step_{};
  std::array<double, kAxes> length_{};
  std::array<double, kAxes> next_{};
};

/// Least s in 0..1 where the cubic through (0, f0), (1/3, f1), (2/3, f2), (1, f3) is not positive; 2 if there is none.
double first_root(double f0, double f1, double f2, double f3) {
  if (f0 <= 0) return 0;
  const double c1 = -5.5 * f0 + 9 * f1 - 4.5 * f2 + f3;
  const double c2 = 9 * f0 - 22.5 * f1 + 18 * f2 - 4.5 * f3;
  const double c3 = -4.5 * f0 + 13.5 * f1 - 13.5 * f2 + 4.5 * f3;
  const auto f = [&](double s) { return ((c3 * s + c2) * s + c1) * s + f0; };
  // Between its turning points a cubic crosses zero at most once.
  std::array<double, 3> ends{1, 1, 1};
  const double square = c2 * c2 - 3 * c3 * c1;
  if (square > 0 && c3 != 0) {
    const double root = std::sqrt(square);
    ends = {std::clamp((-c2 - root) / (3 * c3), 0.0, 1.0), std::clamp((-c2 + root) / (3 * c3), 0.0, 1.0), 1};
  } else if (c3 == 0 && c2 != 0) {
    ends[0] = std::clamp(-c1 / (2 * c2), 0.0, 1.0);
  }
  std::ranges::sort(ends);
  double low = 0;
  for (const double end : ends) {
    if (f(end) <= 0) {
      double high = end;
      for (int i = 0; i < 48; ++i) {  // halves 1 down to the last bits of a double's fraction
        const double middle = 0.5 * (low + high);
        (f(middle) <= 0 ? high : low) = middle;
      }
      return high;
    }
    low = end;
  }
  return 2;
}

/// One ray through the field, in voxels.
class Caster {
 public:
  Caster(const WorldFunction& world, const glm::dvec3& from, const glm::dvec3& direction, DensityBrick& brick)
      : world_(world), from_(from), direction_(direction), brick_(brick) {}

  std::optional<RayHit> cast(double max) {
    const glm::dvec2 range = world_.height_range_m() / world_.voxel_m();
    double begin = 0;
    double end = max;
    if (from_.y < range.x) {
      brick_at(from_);
      return hit(0, {}, {0, 1, 0}, {});
    }
    clip(range.x, range.y, begin, end);
    const double edge = kBrickCells;
    Walk<2> walk({from_.x / edge, from_.z / edge}, {direction_.x / edge, direction_.z / edge}, begin);
    for (; walk.enter() < end; walk.advance()) {
      brick_.stand(world_, walk.box[0] * kBrickCells, walk.box[1] * kBrickCells, 1, kBrickCells);
      if (auto found = cast_brick(walk.enter(), std::min(walk.leave(), end))) return found;
    }
    return std::nullopt;
  }

 private:
  glm::dvec3 at(double t) const { return from_ + direction_ * t; }

  void brick_at(const glm::dvec3& place) {
    const auto corner = [](double c) { return static_cast<std::int64_t>(std::floor(c / kBrickCells)) * kBrickCells; };
    brick_.stand(world_, corner(place.x), corner(place.z), 1, kBrickCells);
  }

  /// Shortens begin..end to where the ray is between two heights.
  void clip(double low, double high, double& begin, double& end) const {
    if (direction_.y == 0) {
      if (from_.y > high || from_.y < low) end = begin;
      return;
    }
    const double a = (low - from_.y) / direction_.y;
    const double b = (high - from_.y) / direction_.y;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }

  /// The part of the ray over one brick.
  std::optional<RayHit> cast_brick(double begin, double end) {
    const double low = std::floor(brick_.rock_below_m() / world_.voxel_m()) - 1;
    const double high = std::ceil(brick_.air_above_m() / world_.voxel_m()) + 1;
    if (at(begin).y < low) return hit(begin, {}, {0, 1, 0}, {});
    clip(low, high, begin, end);
    if (begin >= end) return std::nullopt;
    const double bottom = std::floor(std::min(at(begin).y, at(end).y));
    const double top = std::floor(std::max(at(begin).y, at(end).y)) + 1;
    const auto y_voxel = static_cast<std::int64_t>(bottom);
    const int layers = static_cast<int>(top - bottom) + 1;
    brick_.sample(world_, y_voxel, layers);
    const ColumnGrid& grid = brick_.columns().grid;
    const glm::dvec3 corner(static_cast<double>(grid.x_voxel), bottom, static_cast<double>(grid.z_voxel));
    const glm::dvec3 local = from_ - corner;
    Walk<3> walk({local.x, local.y, local.z}, {direction_.x, direction_.y, direction_.z}, begin);
    for (; walk.enter() < end; walk.advance()) {
      const std::array<int, 3> last{kBrickCells - 1, layers - 2, kBrickCells - 1};
      std::array<int, 3> cell{};
      for (std::size_t a = 0; a < 3; ++a) {
        // A ray along a border may be rounded to its other side.
        cell[a] = static_cast<int>(std::clamp<std::int64_t>(walk.box[a], 0, last[a]));
      }
      if (auto found = cast_cell(cell, local, walk.enter(), std::min(walk.leave(), end))) return found;
    }
    return std::nullopt;
  }

  std::optional<RayHit> cast_cell(const std::array<int, 3>& cell, const glm::dvec3& local, double begin, double end) {
    const std::array<float, 8> corners = brick_.corners(cell[0], cell[1], cell[2]);
    const glm::dvec3 corner(cell[0], cell[1], cell[2]);
    const auto place = [&](double t) {
      const glm::dvec3 inside = local + direction_ * t - corner;
      return glm::dvec3(std::clamp(inside.x, 0.0, 1.0), std::clamp(inside.y, 0.0, 1.0), std::clamp(inside.z, 0.0, 1.0));
    };
    const auto f = [&](double s) { return trilinear(corners, place(begin + (end - begin) * s)); };
    const double s = first_root(f(0), f(1.0 / 3), f(2.0 / 3), f(1));
    if (s > 1) return std::nullopt;
    const double t = begin + (end - begin) * s;
    return hit(t, cell, trilinear_gradient(corners, place(t)), place(t));
  }

  RayHit hit(double t, const std::array<int, 3>& cell, const glm::dvec3& gradient, const glm::dvec3& place) const {
    const ColumnBlock& b = brick_.columns();
    RayHit out;
    out.distance_m = t * world_.voxel_m();
    out.position_m = at(t) * world_.voxel_m();
    const double length = glm::length(gradient);
    out.normal = length > 0 ? gradient / length : glm::dvec3(0, 1, 0);
    const std::size_t column = static_cast<std::size_t>(cell[2] + (place.z > 0.5 ? 1 : 0)) * b.stride +
                               static_cast<std::size_t>(cell[0] + (place.x > 0.5 ? 1 : 0));
    const glm::i64vec2 voxel{b.grid.x_voxel + cell[0] + (place.x > 0.5 ? 1 : 0),
                             b.grid.z_voxel + cell[2] + (place.z > 0.5 ? 1 : 0)};
    const auto height = static_cast<float>(out.position_m.y);
    const auto up = static_cast<float>(out.normal.y);
    out.material = top_m(b, column) - height > kUnderRoof_m
                       ? world_.sheltered(height, up)
                       : world_.cover({height, up, b.ridge[column], b.hilliness[column], b.beach[column], voxel,
                                       b.districts_at(column)});
    if (out.material == Material::kRock)
      out.material = world_.rock({b.stack_m[column], b.choice[column], height, voxel});
    return out;
  }

  const WorldFunction& world_;
  const glm::dvec3 from_;
  const glm::dvec3 direction_;
  DensityBrick& brick_;
};

}  // namespace

std::optional<RayHit> cast_ray(const WorldFunction& world, const glm::dvec3& from_m, const glm::dvec3& direction,
                               double max_m, DensityBrick& brick) {
  const double max = max_m / world.voxel_m();
  TALUS_CHECK(max <= kRayVoxelsMax);
  return Caster(world, from_m / world.voxel_m(), direction, brick).cast(max);
}

}  // namespace talus
