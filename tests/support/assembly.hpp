// Meshes and strips as a client decodes them, put together in one exact lattice, and the edges that do not close.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/grid/chunk_face.hpp"
#include "core/mesh/chunk_mesh.hpp"

namespace talus::test {

/// A place in steps of the finest LOD's lattice: exact at any LOD.
using Place = std::array<std::int64_t, 3>;

/// An edge of a triangle, lower end first, and which way the triangle walks it.
struct Walked {
  Place low;
  Place high;
  int way = 0;  ///< +1 or -1
  friend auto operator<=>(const Walked&, const Walked&) = default;
};

class Assembly {
 public:
  explicit Assembly(int cells) : cells_(cells) {}

  /// A chunk of the view, whether it has a mesh or not.
  void add_place(const ChunkKey& key) { places_.insert(key); }
  void add_mesh(const ChunkKey& key, const ChunkMesh& mesh) { add(key, key.lod, cells_ * kStepsPerCell, mesh); }
  void add_strip(const StripKey& strip, const ChunkMesh& mesh) {
    add(strip.key, strip.key.lod - 1, 2 * cells_ * kStepsPerCell, mesh);
  }

  std::size_t edges() const { return edges_.size() + inner_; }

  /// Edges that are not walked as often one way as the other, or by more than `triangles_max`, but for those on the
  /// hull: next to a place that is not in the view.
  std::vector<Walked> open_edges(std::size_t triangles_max) {
    std::ranges::sort(edges_);
    std::vector<Walked> out;
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t end = i;
      int ways = 0;
      for (; end < edges_.size() && edges_[end].low == edges_[i].low && edges_[end].high == edges_[i].high; ++end) {
        ways += edges_[end].way;
      }
      const bool is_closed = end - i <= triangles_max && ways == 0;
      if (!is_closed && !is_on_hull(edges_[i])) out.push_back(edges_[i]);
      i = end;
    }
    out.insert(out.end(), open_inside_.begin(), open_inside_.end());
    return out;
  }

 private:
  void add(const ChunkKey& key, int lod, int edge_steps, const ChunkMesh& mesh) {
    const glm::i64vec3 corner = corner_voxel(key, cells_) * std::int64_t{kStepsPerCell};
    const auto place = [&](std::uint32_t vertex) {
      const glm::u16vec3& p = mesh.positions[vertex];
      return Place{corner.x + (std::int64_t{p.x} << lod), corner.y + (std::int64_t{p.y} << lod),
                   corner.z + (std::int64_t{p.z} << lod)};
    };
    std::vector<Walked> inside;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::uint32_t from = mesh.indices[i];
      const std::uint32_t to = mesh.indices[i - i % 3 + (i + 1) % 3];
      const Place a = place(from);
      const Place b = place(to);
      const Walked walked = a < b ? Walked{a, b, 1} : Walked{b, a, -1};
      bool is_on_face = false;
      for (int axis = 0; axis < 3; ++axis) {
        const int at = mesh.positions[from][axis];
        is_on_face |= (at == 0 || at == edge_steps) && mesh.positions[to][axis] == at;
      }
      (is_on_face ? edges_ : inside).push_back(walked);
    }
    // Off the faces nobody else has a triangle: these close here or nowhere.
    inner_ += inside.size();
    std::ranges::sort(inside);
    for (std::size_t i = 0; i < inside.size();) {
      const bool is_closed = i + 1 < inside.size() && inside[i].low == inside[i + 1].low &&
                             inside[i].high == inside[i + 1].high && inside[i].way + inside[i + 1].way == 0;
      if (!is_closed) open_inside_.push_back(inside[i]);
      i += is_closed ? 2 : 1;
    }
  }

  bool is_in_view(const Place& doubled) const {
    for (int lod = 0; lod <= kLodMax; ++lod) {
      const std::int64_t edge = 2 * (std::int64_t{cells_ * kStepsPerCell} << lod);
      const auto chunk = [&](std::int64_t at) {
        return static_cast<std::int32_t>((at - ((at % edge) + edge) % edge) / edge);
      };
      if (places_.contains({lod, chunk(doubled[0]), chunk(doubled[1]), chunk(doubled[2])})) return true;
    }
    return false;
  }

  /// Looks half a step into all eight directions from the middle of the edge.
  bool is_on_hull(const Walked& edge) const {
    for (unsigned i = 0; i < 8; ++i) {
      Place at{};
      for (unsigned axis = 0; axis < 3; ++axis)
        at[axis] = edge.low[axis] + edge.high[axis] + ((i >> axis) % 2 == 0 ? 1 : -1);
      if (!is_in_view(at)) return true;
    }
    return false;
  }

  const int cells_;
  std::unordered_set<ChunkKey, ChunkKeyHash> places_;
  std::vector<Walked> edges_;  ///< on faces of chunks
  std::vector<Walked> open_inside_;
  std::size_t inner_ = 0;
};

inline std::string text_of(const Walked& edge) {
  std::string out;
  for (const Place* place : {&edge.low, &edge.high}) {
    for (const std::int64_t at : *place) out += std::to_string(at) + ' ';
  }
  return out;
}

}  // namespace talus::test
