#include "core/mesh/seam_cell.hpp"

#include <cstdlib>
#include <limits>

namespace talus {
namespace {

/// One closed outline: crossings in order, no two neighbours in the same place.
struct Outline {
  std::size_t length = 0;
  std::array<std::uint8_t, kSeamCrossings> crossings{};
};

using Places = std::array<glm::ivec2, kSeamCrossings>;

Outline outline_from(std::uint8_t first, const Places& at, seam_cell::Outlines& next) {
  Outline out;
  for (std::uint8_t crossing = first; next[crossing] != seam_cell::kNone;) {
    if (out.length == 0 || at[out.crossings[out.length - 1]] != at[crossing]) out.crossings[out.length++] = crossing;
    const std::uint8_t following = next[crossing];
    next[crossing] = seam_cell::kNone;
    crossing = following;
  }
  if (out.length > 1 && at[out.crossings[0]] == at[out.crossings[out.length - 1]]) --out.length;
  return out;
}

/// What a triangle costs: its area first, then the squares of its sides, so that among cuts of equal area the one with
/// short diagonals wins. 2^32 is above any sum of squares in a cell of 128 steps.
std::int64_t cost_of(const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
  const glm::ivec2 ab = b - a;
  const glm::ivec2 ac = c - a;
  const glm::ivec2 bc = c - b;
  const std::int64_t area2 = std::abs(ab.x * ac.y - ab.y * ac.x);
  const std::int64_t sides2 = ab.x * ab.x + ab.y * ab.y + ac.x * ac.x + ac.y * ac.y + bc.x * bc.x + bc.y * bc.y;
  return (area2 << 32) + sides2;
}

/// The cheapest cut of an outline. Based on: G. Klincsek, "Minimal triangulations of polygonal domains", 1980; outlines
/// may cross themselves here, which changes nothing.
class Cut {
 public:
  Cut(const Outline& outline, const Places& at) : outline_(outline) {
    for (std::size_t span = 2; span < outline.length; ++span) {
      for (std::size_t i = 0; i + span < outline.length; ++i) {
        const std::size_t k = i + span;
        best_[i][k] = std::numeric_limits<std::int64_t>::max();
        for (std::size_t j = i + 1; j < k; ++j) {
          const std::int64_t cost =
              best_[i][j] + best_[j][k] +
              cost_of(at[outline.crossings[i]], at[outline.crossings[j]], at[outline.crossings[k]]);
          if (cost >= best_[i][k]) continue;
          best_[i][k] = cost;
          apex_[i][k] = j;
        }
      }
    }
  }

  void append(SeamTriangles& out) const {
    if (outline_.length > 2) append(0, outline_.length - 1, out);
  }

 private:
  void append(std::size_t i, std::size_t k, SeamTriangles& out) const {
    const std::size_t j = apex_[i][k];
    for (const std::size_t corner : {i, j, k}) {
      out.crossings[3 * out.count + (corner == i ? 0 : corner == j ? 1 : 2)] = outline_.crossings[corner];
    }
    ++out.count;
    if (j - i > 1) append(i, j, out);
    if (k - j > 1) append(j, k, out);
  }

  template <class T>
  using Table = std::array<std::array<T, kSeamCrossings>, kSeamCrossings>;
  const Outline& outline_;
  Table<std::int64_t> best_{};
  Table<std::size_t> apex_{};
};

}  // namespace

SeamTriangles seam_triangles(unsigned pattern, const Places& at) {
  SeamTriangles out;
  seam_cell::Outlines next = kSeamOutlines[pattern];
  for (std::uint8_t first = 0; first < kSeamCrossings; ++first) {
    if (next[first] == seam_cell::kNone) continue;
    const Outline outline = outline_from(first, at, next);
    if (outline.length > 2) Cut(outline, at).append(out);
  }
  return out;
}

}  // namespace talus
