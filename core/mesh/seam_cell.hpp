// The seam between one cell of a coarse face and the four cells of the finer chunk that touch it.
//
// Problem: on a face between LODs the coarse surface ends along one curve and the fine one along another; light shines
// through between them. Answer: in the plane of the face, per coarse cell, the difference of the two sections: rock of
// the coarse section that is air in the fine one, and the reverse. Its outline runs along the fine contour, along the
// coarse contour backwards, and between the two along the cell's sides, where the neighbouring cell runs along it the
// other way: so seams close by construction, islands and tunnels that only one LOD has included. No vertex is added to
// those of the two meshes, so no edge of either ends in a T. Where the contours cross, the triangles of an outline
// overlap by slivers; the cut with the least area is chosen. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>

namespace talus {

/// The nine samples of a transition cell: bit u + 3 * v of a pattern is set where sample (u, v) is rock; (u, v) run
/// 0..2 in steps of the fine lattice, u x v points out of the coarse chunk.
inline constexpr unsigned kSeamPatterns = 512;
/// Places where a contour can cross the lattice lines of a transition cell: sides of the coarse cell 0..3 (below,
/// above, left, right), fine edges along u at 4 + u + 2 * v, fine edges along v at 10 + u + 3 * v.
inline constexpr std::size_t kSeamCrossings = 16;
inline constexpr std::size_t kSeamTrianglesMax = kSeamCrossings - 2;

namespace seam_cell {

inline constexpr std::uint8_t kNone = 255;
constexpr int fine_along_u(int u, int v) {
  return 4 + u + 2 * v;
}
constexpr int fine_along_v(int u, int v) {
  return 10 + u + 3 * v;
}

/// For each crossing the next one along its outline; kNone where there is none.
using Outlines = std::array<std::uint8_t, kSeamCrossings>;

/// Segments of one square's contour by the face rule of cell_table.hpp: walking counter-clockwise, each run of rock is
/// cut off from where it is entered to where it is left.
constexpr void add_square(const std::array<bool, 4>& rock, const std::array<int, 4>& sides, bool is_reversed,
                          Outlines& next) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (rock[i] || !rock[(i + 1) % 4]) continue;
    std::size_t last = i + 1;
    while (rock[(last + 1) % 4]) ++last;
    const auto entered = static_cast<std::size_t>(sides[i]);
    const auto left = static_cast<std::size_t>(sides[last % 4]);
    next[is_reversed ? left : entered] = static_cast<std::uint8_t>(is_reversed ? entered : left);
  }
}

/// Joins what ends on a side of the coarse cell with what begins there: at most two crossings lie on a side.
constexpr void join_on_side(int coarse, int fine0, int fine1, bool has_coarse, bool has_fine0, bool has_fine1,
                            Outlines& next) {
  if (!has_fine0 && !has_fine1) return;
  const int fine = has_fine0 ? fine0 : fine1;
  const int other = has_coarse ? coarse : fine1;
  const bool ends_here = next[static_cast<std::size_t>(fine)] == kNone;
  const int from = ends_here ? fine : other;
  const int to = ends_here ? other : fine;
  next[static_cast<std::size_t>(from)] = static_cast<std::uint8_t>(to);
}

constexpr Outlines outlines_of(unsigned pattern) {
  Outlines next{};
  next.fill(kNone);
  const auto rock = [&](int u, int v) { return ((pattern >> (u + 3 * v)) & 1U) != 0; };
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 2; ++u) {
      add_square({rock(u, v), rock(u + 1, v), rock(u + 1, v + 1), rock(u, v + 1)},
                 {fine_along_u(u, v), fine_along_v(u + 1, v), fine_along_u(u, v + 1), fine_along_v(u, v)}, false, next);
    }
  }
  add_square({rock(0, 0), rock(2, 0), rock(2, 2), rock(0, 2)}, {0, 3, 1, 2}, true, next);
  for (int i = 0; i < 2; ++i) {
    const int at = 2 * i;
    join_on_side(i, fine_along_u(0, at), fine_along_u(1, at), rock(0, at) != rock(2, at), rock(0, at) != rock(1, at),
                 rock(1, at) != rock(2, at), next);
    join_on_side(2 + i, fine_along_v(at, 0), fine_along_v(at, 1), rock(at, 0) != rock(at, 2),
                 rock(at, 0) != rock(at, 1), rock(at, 1) != rock(at, 2), next);
  }
  return next;
}

}  // namespace seam_cell

inline constexpr std::array<seam_cell::Outlines, kSeamPatterns> kSeamOutlines = [] {
  std::array<seam_cell::Outlines, kSeamPatterns> out{};
  for (unsigned pattern = 0; pattern < kSeamPatterns; ++pattern) out[pattern] = seam_cell::outlines_of(pattern);
  return out;
}();

struct SeamTriangles {
  std::size_t count = 0;
  std::array<std::uint8_t, 3 * kSeamTrianglesMax> crossings{};  ///< three a triangle, counter-clockwise in (u, v)
};

/// Cuts the outlines of `pattern` into triangles, given where its crossings lie (those that the pattern has; any unit).
/// Crossings of equal place count as one. Counter-clockwise triangles are coarse rock against fine air and face the
/// finer chunk; clockwise ones the reverse.
SeamTriangles seam_triangles(unsigned pattern, const std::array<glm::ivec2, kSeamCrossings>& at);

}  // namespace talus
