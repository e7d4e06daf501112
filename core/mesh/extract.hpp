// Marching cubes over a box of samples, with shared vertices on the lattice. Pure; memory is the caller's.
//
// Based on: W. E. Lorensen and H. E. Cline, "Marching Cubes", 1987; W. Schroeder, R. Maynard and B. Geveci, "Flying
// Edges", 2015 (edges are classified by rows before any vertex is made). What differs: a row of samples is one word of
// sign bits, so crossed edges are an exclusive or, and the number of a vertex is a count of bits: no edge cache, no
// hash.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/chunk_mesh.hpp"

namespace talus {

/// Signs of the (cells + 1)^3 samples of a chunk: bit x of word y * (cells + 1) + z is set where the sample is rock.
struct SignRows {
  int cells = 0;  ///< 1..62
  std::vector<std::uint64_t> rows;
};

/// Edges that the surface crosses, row by row, and the number of the first vertex on each row. Row r = y * (cells + 1)
/// + z.
struct CrossedEdges {
  /// Bit x of crossed[axis][r]: the edge from sample (x, y, z) along the axis changes sign.
  std::vector<std::uint64_t> crossed[3];
  std::vector<std::uint32_t> first[3];
  std::uint32_t vertices = 0;
};

/// An edge with a vertex on it: from sample (x, y, z), one step along axis (0 x, 1 y, 2 z).
struct CrossedEdge {
  int axis, x, y, z;
};

/// Finds the crossed edges and numbers their vertices: by axis within a row, rows in order.
void find_crossed_edges(const SignRows& signs, CrossedEdges& out);

/// Appends the triangles of every cell, as vertex numbers; `out` is cleared first. No triangle is degenerate or doubled
/// as long as each vertex lies strictly inside its edge.
void extract_triangles(const SignRows& signs, const CrossedEdges& edges, std::vector<std::uint32_t>& out);

/// Calls make(CrossedEdge) for vertices 0, 1, 2 ... in order.
template <class Make>
void for_each_crossed_edge(const SignRows& signs, const CrossedEdges& edges, Make make) {
  const int samples = signs.cells + 1;
  for (int y = 0; y < samples; ++y) {
    for (int z = 0; z < samples; ++z) {
      const auto row = static_cast<std::size_t>(y * samples + z);
      for (int axis = 0; axis < 3; ++axis) {
        for (std::uint64_t left = edges.crossed[axis][row]; left != 0; left &= left - 1) {
          make(CrossedEdge{axis, std::countr_zero(left), y, z});
        }
      }
    }
  }
}

/// How near a vertex comes to the ends of its edge, in lattice steps. A surface that grazes a sample would leave
/// slivers around it: with 4 of 64 steps no triangle of a cell has an angle below 3 degrees, with 1 they go down to
/// 0.7. Costs at most 1/16 of a cell of place, where a surface passes a sample within that.
inline constexpr int kCrossingMarginSteps = kStepsPerCell / 16;

/// Where on an edge the surface crosses it, in lattice steps, given the densities at its ends (of unlike sign): held
/// kCrossingMarginSteps inside of both. So no two vertices of a chunk coincide, and three on the edges of a convex cell
/// are never in a line.
int crossing_step(float from, float to);

}  // namespace talus
