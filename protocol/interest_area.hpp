// Which chunks a viewer needs: one LOD per place, neighbours differing by at most one. Pure; SPEC.md section "Interest
// area".
//
// Radius r(L) = near_m * 2^-lod_bias * 2^L, at least kNearEdgesMin edges at LOD 0. A node of LOD L >= 1 is split when
// its box is nearer than r(L - 1). Start from every LOD kViewLodMax chunk that meets the heights of the world and lies
// within far_m of the viewer (horizontally); a node that is further than far_m or does not meet the heights is dropped,
// at every LOD. Distances are Euclidean, from the viewer to the nearest point of a box. Why neighbours differ by at
// most one: SPEC.md, "Interest area".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/grid/chunk_key.hpp"
#include "protocol/limits.hpp"

namespace talus::protocol {

/// What of a world the interest area depends on.
struct WorldShape {
  int cells = 32;
  double voxel_m = 1.0;
  glm::dvec2 height_range_m{-1000.0, 4000.0};
};

/// Metres of a chunk's edge at `lod`, or of a column's; any LOD, those without chunks too.
double edge_of(const WorldShape& shape, int lod);

/// A view as it came; any bits.
struct View {
  glm::dvec3 position{};
  glm::dvec3 direction{0.0, 0.0, -1.0};
  glm::dvec3 velocity{};
  double near_m = 128.0;
  double far_m = 12'000.0;
  double lod_bias = 0.0;
};

/// `view` with every field finite and within limits: NaN becomes the default, infinity the limit, positions the nearest
/// place inside the world.
View clamped(const View& view, const WorldShape& shape);

/// The area of one clamped view: its leaves, and whether a chunk is one of them.
class InterestArea {
 public:
  InterestArea(const View& view, const WorldShape& shape);

  /// Appends the leaves, without duplicates, in the order of the octree (core/grid/octree_order.hpp).
  void append_leaves(std::vector<ChunkKey>& out) const;
  /// Whether `key` is a leaf: what the walk would find, without walking. Mostly one distance.
  bool has_leaf(const ChunkKey& key) const;

 private:
  enum class Node : std::uint8_t { kDropped, kSplit, kLeaf };
  Node node(const ChunkKey& key) const;
  void visit(const ChunkKey& key, std::vector<ChunkKey>& out) const;

  WorldShape shape_;
  glm::dvec3 position_;
  double far_m_;
  std::array<double, kViewLodMax> radius2_{};  ///< r(lod)^2
};

/// The leaves, without duplicates, in the order of the octree (core/grid/octree_order.hpp). Requires a clamped view.
/// `out` is cleared first.
void interest_area(const View& view, const WorldShape& shape, std::vector<ChunkKey>& out);

/// Smaller is sooner: distance over edge, less for what lies ahead. Requires a clamped view.
double chunk_urgency(const View& view, const WorldShape& shape, const ChunkKey& key);

}  // namespace talus::protocol
