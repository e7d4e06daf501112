// Marching-cubes triangles of the 256 sign patterns of a cell, derived at compile time from one face rule.
//
// Problem: copied tables are long, and wrong on ambiguous faces in ways that only show as holes. Answer: on every face
// the contour's segments are fixed by the face's four signs alone (rock corners that only touch diagonally are kept
// apart), so two cells that share a face agree; segments chain into loops; a loop is cut into a fan that never lies in
// a face of the cell. Based on: W. E. Lorensen and H. E. Cline, "Marching Cubes", 1987; the face rule is that of G. M.
// Nielson and B. Hamann, "The Asymptotic Decider", 1991, with the decision fixed instead of computed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace talus {

/// Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2). Bit c of a pattern is set where corner c is rock.
/// Edge e runs along axis e / 4: from (0, e & 1, e >> 1 & 1) along x, (e & 1, 0, e >> 1 & 1) along y, (e & 1, e >> 1 &
/// 1, 0) along z, reading e modulo 4.
struct CellTriangles {
  std::uint8_t count = 0;                   ///< triangles
  std::array<std::uint8_t, 3 * 5> edges{};  ///< three per triangle, counter-clockwise seen from the air
};

namespace cell_table {

constexpr int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  const int low = a < b ? a : b;
  const int x = low & 1;
  const int y = (low >> 1) & 1;
  const int z = low >> 2;
  if (axis == 0) return y + 2 * z;
  if (axis == 1) return 4 + x + 2 * z;
  return 8 + x + 2 * y;
}

/// Corners of each face, counter-clockwise seen from outside the cell: -x +x -y +y -z +z.
inline constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

constexpr std::array<unsigned, 12> faces_of_edges() {
  std::array<unsigned, 12> out{};
  for (std::size_t f = 0; f < 6; ++f) {
    for (std::size_t i = 0; i < 4; ++i) {
      out[static_cast<std::size_t>(edge_between(kFaces[f][i], kFaces[f][(i + 1) % 4]))] |= 1U << f;
    }
  }
  return out;
}

/// For each crossed edge the next one along its contour loop, -1 elsewhere. Walking a face counter-clockwise, a segment
/// joins the edge where rock is entered with the edge where that run of rock is left.
constexpr std::array<int, 12> contour_of(unsigned pattern) {
  std::array<int, 12> next{};
  next.fill(-1);
  const auto rock = [&](int corner) { return ((pattern >> corner) & 1U) != 0; };
  for (const auto& face : kFaces) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (rock(face[i]) || !rock(face[(i + 1) % 4])) continue;
      std::size_t last = i + 1;
      while (rock(face[(last + 1) % 4])) ++last;
      const int entered = edge_between(face[i], face[(i + 1) % 4]);
      const int left = edge_between(face[last % 4], face[(last + 1) % 4]);
      next[static_cast<std::size_t>(entered)] = left;
    }
  }
  return next;
}

/// Whether the fan of `loop` around its vertex `start` keeps clear of the cell's faces.
constexpr bool fan_is_inside(const std::array<int, 12>& loop, int length, int start) {
  const auto faces = faces_of_edges();
  const auto at = [&](int i) {
    return faces[static_cast<std::size_t>(loop[static_cast<std::size_t>((start + i) % length)])];
  };
  for (int i = 1; i + 1 < length; ++i) {
    if ((at(0) & at(i) & at(i + 1)) != 0) return false;
  }
  return true;
}

constexpr CellTriangles triangles_of(unsigned pattern) {
  CellTriangles out;
  auto next = contour_of(pattern);
  for (int first = 0; first < 12; ++first) {
    if (next[static_cast<std::size_t>(first)] < 0) continue;
    std::array<int, 12> loop{};
    int length = 0;
    for (int e = first; next[static_cast<std::size_t>(e)] >= 0;) {
      loop[static_cast<std::size_t>(length++)] = e;
      const int following = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = -1;
      e = following;
    }
    int start = 0;
    while (start < length && !fan_is_inside(loop, length, start)) ++start;
    for (int i = 1; i + 1 < length; ++i) {
      for (const int corner : {0, i, i + 1}) {
        const auto vertex = loop[static_cast<std::size_t>((start + corner) % length)];
        out.edges[static_cast<std::size_t>(3 * out.count + (corner == 0   ? 0
                                                            : corner == i ? 1
                                                                          : 2))] = static_cast<std::uint8_t>(vertex);
      }
      ++out.count;
    }
  }
  return out;
}

constexpr bool every_loop_has_a_fan() {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    const CellTriangles triangles = triangles_of(pattern);
    const auto faces = faces_of_edges();
    for (std::size_t t = 0; t < triangles.count; ++t) {
      if ((faces[triangles.edges[3 * t]] & faces[triangles.edges[3 * t + 1]] & faces[triangles.edges[3 * t + 2]]) !=
          0) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace cell_table

inline constexpr std::array<CellTriangles, 256> kCellTriangles = [] {
  std::array<CellTriangles, 256> out{};
  for (unsigned pattern = 0; pattern < 256; ++pattern) out[pattern] = cell_table::triangles_of(pattern);
  return out;
}();
static_assert(cell_table::every_loop_has_a_fan(), "a triangle in a face would coincide with the neighbour's");

}  // namespace talus
