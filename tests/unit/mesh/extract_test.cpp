#include "core/mesh/extract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include <glm/geometric.hpp>

#include "core/mesh/cell_table.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSignSeed = 99;

bool rock(const SignRows& signs, int x, int y, int z) {
  return (signs.rows[static_cast<std::size_t>(y * (signs.cells + 1) + z)] >> x & 1U) != 0;
}

SignRows random_signs(test::Random& random, int cells, double share) {
  SignRows signs{cells, {}};
  for (int r = 0; r < (cells + 1) * (cells + 1); ++r) {
    std::uint64_t row = 0;
    for (int x = 0; x <= cells; ++x) row |= static_cast<std::uint64_t>(random.unit() < share) << x;
    signs.rows.push_back(row);
  }
  return signs;
}

TEST(CellTable, ShowsACornerOfRockTheWayOut) {
  // Rock at the origin only: one triangle whose normal points away from it.
  const CellTriangles& t = kCellTriangles[1];
  ASSERT_EQ(t.count, 1);
  EXPECT_EQ((std::array{t.edges[0], t.edges[1], t.edges[2]}), (std::array<std::uint8_t, 3>{0, 4, 8}));
}

TEST(CellTable, CutsEveryCrossedEdgeAndNoOther) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    std::set<int> crossed;
    for (int a = 0; a < 8; ++a) {
      for (const int bit : {1, 2, 4}) {
        const int b = a ^ bit;
        if (a < b && ((pattern >> a ^ pattern >> b) & 1U) != 0) crossed.insert(cell_table::edge_between(a, b));
      }
    }
    const CellTriangles& t = kCellTriangles[pattern];
    const std::set<int> used(t.edges.begin(), t.edges.begin() + 3 * t.count);
    EXPECT_EQ(used, crossed) << pattern;
  }
}

TEST(Extract, FindsTheEdgesThatASlowSearchFinds) {
  test::Random random(kSignSeed);
  for (const int cells : {1, 2, 5, 16, 32}) {
    const SignRows signs = random_signs(random, cells, 0.5);
    CrossedEdges edges;
    find_crossed_edges(signs, edges);
    std::set<std::tuple<int, int, int, int>> slow;
    for (int y = 0; y <= cells; ++y) {
      for (int z = 0; z <= cells; ++z) {
        for (int x = 0; x <= cells; ++x) {
          if (x < cells && rock(signs, x, y, z) != rock(signs, x + 1, y, z)) slow.insert({0, x, y, z});
          if (y < cells && rock(signs, x, y, z) != rock(signs, x, y + 1, z)) slow.insert({1, x, y, z});
          if (z < cells && rock(signs, x, y, z) != rock(signs, x, y, z + 1)) slow.insert({2, x, y, z});
        }
      }
    }
    std::set<std::tuple<int, int, int, int>> fast;
    std::uint32_t count = 0;
    for_each_crossed_edge(signs, edges, [&](const CrossedEdge& e) {
      fast.insert({e.axis, e.x, e.y, e.z});
      ++count;
    });
    EXPECT_EQ(fast, slow);
    EXPECT_EQ(count, edges.vertices);
  }
}

TEST(Extract, ClosesEverySurfaceInsideTheChunkWhateverTheSigns) {
  test::Random random(kSignSeed);
  for (int round = 0; round < test::rounds(120); ++round) {
    const int cells = round % 6 != 5 ? 6 : 32;
    const SignRows signs = random_signs(random, cells, random.real(0.02, 0.98));
    CrossedEdges edges;
    find_crossed_edges(signs, edges);
    std::vector<CrossedEdge> vertices;
    for_each_crossed_edge(signs, edges, [&](const CrossedEdge& e) { vertices.push_back(e); });
    std::vector<std::uint32_t> indices;
    extract_triangles(signs, edges, indices);

    // A side walked one way by one triangle is walked the other way by another, unless it lies in a face of the chunk.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    std::set<std::array<std::uint32_t, 3>> seen;
    for (std::size_t t = 0; t < indices.size(); t += 3) {
      std::array<std::uint32_t, 3> corners{indices[t], indices[t + 1], indices[t + 2]};
      for (int i = 0; i < 3; ++i) {
        ASSERT_LT(corners[static_cast<std::size_t>(i)], edges.vertices);
        ++sides[{corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>((i + 1) % 3)]}];
      }
      std::ranges::sort(corners);
      ASSERT_TRUE(corners[0] != corners[1] && corners[1] != corners[2]) << "degenerate";
      ASSERT_TRUE(seen.insert(corners).second) << "the same triangle twice, seed " << kSignSeed << ", round " << round;
    }
    const auto in_faces = [&](const CrossedEdge& e) {
      unsigned mask = 0;
      if (e.axis != 0) mask |= (e.x == 0 ? 1U : 0U) | (e.x == cells ? 2U : 0U);
      if (e.axis != 1) mask |= (e.y == 0 ? 4U : 0U) | (e.y == cells ? 8U : 0U);
      if (e.axis != 2) mask |= (e.z == 0 ? 16U : 0U) | (e.z == cells ? 32U : 0U);
      return mask;
    };
    for (const auto& [side, uses] : sides) {
      const auto back = sides.find({side.second, side.first});
      const int other = back == sides.end() ? 0 : back->second;
      if (uses == other) continue;
      ASSERT_NE(in_faces(vertices[side.first]) & in_faces(vertices[side.second]), 0U)
          << "open inside the chunk, seed " << kSignSeed << ", round " << round;
    }
  }
}

TEST(Extract, KeepsCrossingsAMarginInsideTheirEdge) {
  constexpr int kLast = kStepsPerCell - kCrossingMarginSteps;
  EXPECT_EQ(crossing_step(-1.0f, 1.0f), kStepsPerCell / 2);
  EXPECT_EQ(crossing_step(-1.0f, 15.0f), kCrossingMarginSteps);
  EXPECT_EQ(crossing_step(-1.0f, 9.0f), 6);
  EXPECT_EQ(crossing_step(-1e-30f, 5.0f), kCrossingMarginSteps);
  EXPECT_EQ(crossing_step(0.0f, -5.0f), kCrossingMarginSteps);
  EXPECT_EQ(crossing_step(5.0f, -1e-30f), kLast);
  test::Random random(kSignSeed);
  for (int i = 0; i < 10'000; ++i) {
    const auto a = static_cast<float>(random.real(0, 10));
    const auto b = static_cast<float>(random.real(-10, -1e-6));
    // One edge, seen from its two ends: the same place.
    EXPECT_NEAR(crossing_step(a, b), kStepsPerCell - crossing_step(b, a), 1);
  }
}

/// Where a vertex on `edge` of a cell lies, `step` from the edge's lower end.
glm::dvec3 place_on(int edge, int step) {
  const int axis = edge / 4;
  glm::dvec3 out{};
  out[axis] = step;
  out[axis == 0 ? 1 : 0] = kStepsPerCell * (edge & 1);
  out[axis == 2 ? 1 : 2] = kStepsPerCell * (edge >> 1 & 1);
  return out;
}

/// Sine of the angle at `at`, towards `b` and `c`.
double sine_at(const glm::dvec3& at, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::length(glm::cross(b - at, c - at)) / (glm::length(b - at) * glm::length(c - at));
}

TEST(Extract, LeavesNoTriangleWithAnAngleBelowThreeDegrees) {
  // Angles are least where vertices are as far out as they may be.
  constexpr std::array<int, 3> kSteps{kCrossingMarginSteps, kStepsPerCell / 2, kStepsPerCell - kCrossingMarginSteps};
  double least = 1.0;
  for (const CellTriangles& cell : kCellTriangles) {
    for (std::size_t t = 0; t < 3U * cell.count; t += 3) {
      for (int choice = 0; choice < 27; ++choice) {
        const glm::dvec3 a = place_on(cell.edges[t], kSteps[static_cast<std::size_t>(choice % 3)]);
        const glm::dvec3 b = place_on(cell.edges[t + 1], kSteps[static_cast<std::size_t>(choice / 3 % 3)]);
        const glm::dvec3 c = place_on(cell.edges[t + 2], kSteps[static_cast<std::size_t>(choice / 9)]);
        least = std::min({least, sine_at(a, b, c), sine_at(b, c, a), sine_at(c, a, b)});
      }
    }
  }
  EXPECT_GT(least, std::sin(3.0 * std::numbers::pi / 180.0));
}

}  // namespace
}  // namespace talus
