#include "protocol/interest_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/octree_order.hpp"
#include "protocol/limits.hpp"

namespace talus::protocol {
namespace {

/// Metres per second; beyond it prediction is of no use to anyone.
constexpr double kSpeedMax = 1000.0;
/// chunk_urgency looks this far ahead along the velocity: about the time a fresh chunk needs to arrive.
constexpr double kAhead_s = 1.0;

double clamp_or(double value, double absent, double low, double high) {
  return std::isnan(value) ? absent : std::clamp(value, low, high);
}

/// A direction of length 1, or `absent` when there is none to be had. Infinite components win over finite ones.
glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& absent) {
  glm::dvec3 scaled{};
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isnan(v[i])) return absent;
    largest = std::max(largest, std::abs(v[i]));
  }
  if (largest == 0) return absent;
  // Scaled first, so that neither the largest nor the smallest double leaves the range of its square.
  for (int i = 0; i < 3; ++i) {
    scaled[i] = std::isinf(largest) ? (std::isinf(v[i]) ? std::copysign(1.0, v[i]) : 0.0) : v[i] / largest;
  }
  return scaled / std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

/// Distance along one axis from `at` to the closed interval; 0 inside.
double gap(double at, double low, double high) {
  return std::max({low - at, at - high, 0.0});
}

/// Squared Euclidean distance to the nearest point of a box. The order of the sum is part of SPEC.md.
double distance2(const glm::dvec3& at, const BoxWorld& box) {
  const double dx = gap(at.x, box.low.x, box.high.x);
  const double dy = gap(at.y, box.low.y, box.high.y);
  const double dz = gap(at.z, box.low.z, box.high.z);
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

double edge_of(const WorldShape& shape, int lod) {
  return std::ldexp(shape.cells * shape.voxel_m, lod);
}

View clamped(const View& view, const WorldShape& shape) {
  const View initial;
  const double edge = edge_of(shape, 0);
  const double reach = static_cast<double>(kChunkLimit) * edge;
  View out;
  for (int i = 0; i < 3; ++i) {
    out.position[i] = clamp_or(view.position[i], initial.position[i], -reach, reach);
    out.velocity[i] = clamp_or(view.velocity[i], initial.velocity[i], -kSpeedMax, kSpeedMax);
  }
  out.direction = unit_or(view.direction, initial.direction);
  out.lod_bias = clamp_or(view.lod_bias, initial.lod_bias, -kLodBiasMax, kLodBiasMax);
  // The limits hold for what the bias makes of near_m: near_m * 2^-lod_bias.
  const double scale = std::exp2(out.lod_bias);
  out.near_m = std::clamp(std::isnan(view.near_m) ? initial.near_m : view.near_m, kNearEdgesMin * edge * scale,
                          kNearEdgesMax * edge * scale);
  out.far_m = clamp_or(view.far_m, initial.far_m, 0.0, kFarMax);
  return out;
}

InterestArea::InterestArea(const View& view, const WorldShape& shape)
    : shape_(shape), position_(view.position), far_m_(view.far_m) {
  const double r0 = std::max(view.near_m * std::exp2(-view.lod_bias), kNearEdgesMin * edge_of(shape, 0));
  for (int lod = 0; lod < kViewLodMax; ++lod) {
    const double r = r0 * static_cast<double>(1 << lod);
    radius2_[static_cast<std::size_t>(lod)] = r * r;
  }
}

/// What becomes of a node that the walk meets.
InterestArea::Node InterestArea::node(const ChunkKey& key) const {
  const BoxWorld box = box_of(key, shape_.cells, shape_.voxel_m);
  const double d2 = distance2(position_, box);
  if (d2 > far_m_ * far_m_) return Node::kDropped;
  if (box.low.y > shape_.height_range_m.y || box.high.y <= shape_.height_range_m.x) return Node::kDropped;
  if (key.lod > 0 && d2 < radius2_[static_cast<std::size_t>(key.lod - 1)]) return Node::kSplit;
  return is_valid(key) ? Node::kLeaf : Node::kDropped;
}

void InterestArea::visit(const ChunkKey& key, std::vector<ChunkKey>& out) const {
  switch (node(key)) {
    case Node::kDropped:
      return;
    case Node::kLeaf:
      return out.push_back(key);
    case Node::kSplit:
      for (const ChunkKey& child : children_of(key)) visit(child, out);
  }
}

void InterestArea::append_leaves(std::vector<ChunkKey>& out) const {
  const double edge = edge_of(shape_, kViewLodMax);
  const auto chunk = [&](double metres) { return static_cast<std::int32_t>(std::floor(metres / edge)); };
  const glm::ivec3 low{chunk(position_.x - far_m_), chunk(shape_.height_range_m.x), chunk(position_.z - far_m_)};
  const glm::ivec3 high{chunk(position_.x + far_m_), chunk(shape_.height_range_m.y), chunk(position_.z + far_m_)};
  std::vector<ChunkKey> roots;
  for (std::int32_t z = low.z; z <= high.z; ++z) {
    for (std::int32_t x = low.x; x <= high.x; ++x) {
      for (std::int32_t y = low.y; y <= high.y; ++y) roots.push_back({kViewLodMax, x, y, z});
    }
  }
  std::ranges::sort(roots, is_before_in_octree);
  for (const ChunkKey& root : roots) visit(root, out);
}

bool InterestArea::has_leaf(const ChunkKey& key) const {
  if (key.lod > kViewLodMax || node(key) != Node::kLeaf) return false;
  for (ChunkKey above = key; above.lod < kViewLodMax;) {
    above = parent_of(above);
    if (node(above) != Node::kSplit) return false;
  }
  return true;
}

void interest_area(const View& view, const WorldShape& shape, std::vector<ChunkKey>& out) {
  out.clear();
  InterestArea(view, shape).append_leaves(out);
}

double chunk_urgency(const View& view, const WorldShape& shape, const ChunkKey& key) {
  const BoxWorld box = box_of(key, shape.cells, shape.voxel_m);
  const double edge = box.high.x - box.low.x;
  const double here2 = distance2(view.position, box);
  const double soon2 = distance2(view.position + kAhead_s * view.velocity, box);
  const double edges_away = std::sqrt(std::min(here2, soon2)) / edge;

  const glm::dvec3 towards = 0.5 * (box.low + box.high) - view.position;
  const double length = std::sqrt(towards.x * towards.x + towards.y * towards.y + towards.z * towards.z);
  const double along = towards.x * view.direction.x + towards.y * view.direction.y + towards.z * view.direction.z;
  const double ahead = length > 0 ? along / length : 1.0;  // 1 ahead .. -1 behind
  // Behind waits three times as long as ahead; half an edge keeps the chunk one stands in comparable to its neighbours.
  return (edges_away + 0.5) * (2.0 - ahead);
}

}  // namespace talus::protocol
