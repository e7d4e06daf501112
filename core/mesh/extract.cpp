#include "core/mesh/extract.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/check.hpp"
#include "core/mesh/cell_table.hpp"

namespace talus {
namespace {

/// Where an edge of a cell has its vertex number: which axis, which of the cell's four rows, and which of its two
/// columns.
struct EdgePlace {
  std::uint8_t axis;
  std::uint8_t row;  ///< dy + 2 * dz
  std::uint8_t dx;
};

constexpr std::array<EdgePlace, 12> edge_places() {
  std::array<EdgePlace, 12> out{};
  for (std::uint8_t e = 0; e < 4; ++e) {
    const std::uint8_t low = e & 1;
    const std::uint8_t high = e >> 1;
    out[e] = {0, static_cast<std::uint8_t>(low + 2 * high), 0};
    out[4U + e] = {1, static_cast<std::uint8_t>(2 * high), low};
    out[8U + e] = {2, high, low};
  }
  return out;
}
constexpr auto kEdgePlaces = edge_places();

/// x86-64 guarantees no POPCNT, and without it every count is a call: these functions exist twice and the loader picks
/// one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TALUS_COUNTS_BITS [[gnu::target_clones("popcnt", "default")]]
#else
#define TALUS_COUNTS_BITS
#endif

/// Most vertex numbers one row of cells can ask for: 62 cells of 5 triangles.
constexpr std::size_t kRowIndicesMax = 62 * 5 * 3;

}  // namespace

TALUS_COUNTS_BITS void find_crossed_edges(const SignRows& signs, CrossedEdges& out) {
  TALUS_CHECK(signs.cells >= 1 && signs.cells <= 62);
  const auto samples = static_cast<std::size_t>(signs.cells) + 1;
  const std::size_t count = samples * samples;
  TALUS_CHECK(signs.rows.size() >= count);
  for (int axis = 0; axis < 3; ++axis) {
    out.crossed[axis].resize(count);
    out.first[axis].resize(count);
  }
  const std::uint64_t along_x = (std::uint64_t{1} << signs.cells) - 1;
  std::uint32_t next = 0;
  for (std::size_t y = 0; y < samples; ++y) {
    for (std::size_t z = 0; z < samples; ++z) {
      const std::size_t r = y * samples + z;
      const std::uint64_t row = signs.rows[r];
      out.crossed[0][r] = (row ^ (row >> 1)) & along_x;
      out.crossed[1][r] = y + 1 < samples ? row ^ signs.rows[r + samples] : 0;
      out.crossed[2][r] = z + 1 < samples ? row ^ signs.rows[r + 1] : 0;
      for (int axis = 0; axis < 3; ++axis) {
        out.first[axis][r] = next;
        next += static_cast<std::uint32_t>(std::popcount(out.crossed[axis][r]));
      }
    }
  }
  out.vertices = next;
}

TALUS_COUNTS_BITS void extract_triangles(const SignRows& signs, const CrossedEdges& edges,
                                         std::vector<std::uint32_t>& out) {
  out.clear();
  const auto cells = static_cast<std::size_t>(signs.cells);
  const std::size_t samples = cells + 1;
  std::array<std::uint32_t, kRowIndicesMax> found;
  const std::uint64_t all_cells = (std::uint64_t{1} << cells) - 1;
  for (std::size_t y = 0; y < cells; ++y) {
    for (std::size_t z = 0; z < cells; ++z) {
      // Rows (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1).
      const std::size_t r = y * samples + z;
      const std::array<std::size_t, 4> rows{r, r + samples, r + 1, r + samples + 1};
      const std::array<std::uint64_t, 4> s{signs.rows[rows[0]], signs.rows[rows[1]], signs.rows[rows[2]],
                                           signs.rows[rows[3]]};
      const std::uint64_t any = s[0] | s[1] | s[2] | s[3];
      const std::uint64_t all = s[0] & s[1] & s[2] & s[3];
      std::size_t count = 0;
      for (std::uint64_t left = (any | any >> 1) & ~(all & all >> 1) & all_cells; left != 0; left &= left - 1) {
        const int x = std::countr_zero(left);
        const std::uint64_t pattern =
            (s[0] >> x & 3) | (s[1] >> x & 3) << 2 | (s[2] >> x & 3) << 4 | (s[3] >> x & 3) << 6;
        const CellTriangles& triangles = kCellTriangles[pattern];
        const std::size_t corners = std::size_t{3} * triangles.count;
        for (std::size_t i = 0; i < corners; ++i) {
          const EdgePlace place = kEdgePlaces[triangles.edges[i]];
          const std::size_t row = rows[place.row];
          const std::uint64_t before = (std::uint64_t{1} << (x + place.dx)) - 1;
          found[count + i] = edges.first[place.axis][row] +
                             static_cast<std::uint32_t>(std::popcount(edges.crossed[place.axis][row] & before));
        }
        count += corners;
      }
      out.insert(out.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }
}

int crossing_step(float from, float to) {
  const float t = from / (from - to);
  const auto step = static_cast<int>(t * static_cast<float>(kStepsPerCell) + 0.5f);
  return std::clamp(step, kCrossingMarginSteps, kStepsPerCell - kCrossingMarginSteps);
}

}  // namespace talus
