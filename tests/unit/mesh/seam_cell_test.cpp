#include "core/mesh/seam_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kCellSeed = 512;
/// Steps along a fine edge, and along a side of the coarse cell.
constexpr int kFine = 64;
constexpr int kSide = 2 * kFine;

using Point = std::pair<int, int>;
using Segment = std::pair<Point, Point>;
/// How often a segment is walked, less how often it is walked backwards.
using Chain = std::map<Segment, int>;

void walk(Chain& chain, const Point& from, const Point& to, int times = 1) {
  if (from == to) return;
  const auto add = [&](const Segment& segment, int change) {
    if ((chain[segment] += change) == 0) chain.erase(segment);
  };
  from < to ? add({from, to}, times) : add({to, from}, -times);
}

/// A transition cell written down without the tables: signs, and where contours cross the lattice lines.
struct Cell {
  std::array<bool, 9> rock{};
  std::array<int, 6> fine_u{};  ///< crossings on the six fine edges along u, 1..63
  std::array<int, 6> fine_v{};
  std::array<int, 4> sides{};  ///< below, above, left, right: 1..63 of the coarse lattice

  bool at(int u, int v) const { return rock[static_cast<std::size_t>(u + 3 * v)]; }
  Point on_u(int u, int v) const { return {kFine * u + fine_u[static_cast<std::size_t>(u + 2 * v)], kFine * v}; }
  Point on_v(int u, int v) const { return {kFine * u, kFine * v + fine_v[static_cast<std::size_t>(u + 3 * v)]}; }
  Point side(int i) const {
    const int along = 2 * sides[static_cast<std::size_t>(i)];
    return i == 0 ? Point{along, 0} : i == 1 ? Point{along, kSide} : i == 2 ? Point{0, along} : Point{kSide, along};
  }
  unsigned pattern() const {
    unsigned out = 0;
    for (std::size_t i = 0; i < 9; ++i) out |= static_cast<unsigned>(rock[i]) << i;
    return out;
  }
  std::array<glm::ivec2, kSeamCrossings> places() const {
    std::array<glm::ivec2, kSeamCrossings> out{};
    const auto put = [&](int i, const Point& p) { out[static_cast<std::size_t>(i)] = {p.first, p.second}; };
    for (int i = 0; i < 4; ++i) put(i, side(i));
    for (int u = 0; u < 2; ++u) {
      for (int v = 0; v < 3; ++v) {
        put(seam_cell::fine_along_u(u, v), on_u(u, v));
        put(seam_cell::fine_along_v(v, u), on_v(v, u));
      }
    }
    return out;
  }
};

Cell random_cell(unsigned pattern, test::Random& random) {
  Cell out;
  for (std::size_t i = 0; i < 9; ++i) out.rock[i] = ((pattern >> i) & 1U) != 0;
  const auto fill = [&](auto& values) {
    for (int& value : values) value = static_cast<int>(random.whole(1, kFine - 1));
  };
  fill(out.fine_u);
  fill(out.fine_v);
  fill(out.sides);
  return out;
}

/// Polygons of rock in a square whose corners and side crossings are given counter-clockwise: one for each run of rock.
std::vector<std::vector<Point>> rock_in(const std::array<bool, 4>& rock, const std::array<Point, 4>& corner,
                                        const std::array<Point, 4>& crossing) {
  if (std::ranges::count(rock, true) == 4) return {{corner.begin(), corner.end()}};
  std::vector<std::vector<Point>> out;
  for (std::size_t i = 0; i < 4; ++i) {
    if (rock[i] || !rock[(i + 1) % 4]) continue;
    std::vector<Point> polygon{crossing[i]};
    std::size_t at = i + 1;
    for (; rock[at % 4]; ++at) polygon.push_back(corner[at % 4]);
    polygon.push_back(crossing[(at - 1) % 4]);
    out.push_back(polygon);
  }
  return out;
}

std::vector<std::vector<Point>> coarse_rock(const Cell& c) {
  return rock_in({c.at(0, 0), c.at(2, 0), c.at(2, 2), c.at(0, 2)}, {{{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}}},
                 {c.side(0), c.side(3), c.side(1), c.side(2)});
}

std::vector<std::vector<Point>> fine_rock(const Cell& c) {
  std::vector<std::vector<Point>> out;
  for (int u = 0; u < 2; ++u) {
    for (int v = 0; v < 2; ++v) {
      const auto corner = [&](int du, int dv) { return Point{kFine * (u + du), kFine * (v + dv)}; };
      const auto found = rock_in({c.at(u, v), c.at(u + 1, v), c.at(u + 1, v + 1), c.at(u, v + 1)},
                                 {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)},
                                 {c.on_u(u, v), c.on_v(u + 1, v), c.on_u(u, v + 1), c.on_v(u, v)});
      out.insert(out.end(), found.begin(), found.end());
    }
  }
  return out;
}

/// Splits what runs along the lattice lines at every step, so that chains of different cuts can be compared.
void walk_finely(Chain& chain, const Point& from, const Point& to, int times) {
  const int du = (to.first > from.first) - (to.first < from.first);
  const int dv = (to.second > from.second) - (to.second < from.second);
  if (du != 0 && dv != 0) return walk(chain, from, to, times);
  for (Point at = from; at != to;) {
    const Point next{at.first + du, at.second + dv};
    walk(chain, at, next, times);
    at = next;
  }
}

Chain outline_of(const std::vector<std::vector<Point>>& polygons, int times) {
  Chain out;
  for (const auto& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      walk_finely(out, polygon[i], polygon[(i + 1) % polygon.size()], times);
    }
  }
  return out;
}

/// What the triangles of a cell are bounded by.
Chain outline_of(const SeamTriangles& triangles, const std::array<glm::ivec2, kSeamCrossings>& at) {
  Chain out;
  for (std::size_t t = 0; t < triangles.count; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::ivec2& from = at[triangles.crossings[3 * t + i]];
      const glm::ivec2& to = at[triangles.crossings[3 * t + (i + 1) % 3]];
      walk(out, {from.x, from.y}, {to.x, to.y});
    }
  }
  return out;
}

Chain in_steps(const Chain& chain) {
  Chain out;
  for (const auto& [segment, times] : chain) walk_finely(out, segment.first, segment.second, times);
  return out;
}

Chain sum(const Chain& a, const Chain& b) {
  Chain out = a;
  for (const auto& [segment, times] : b) walk(out, segment.first, segment.second, times);
  return out;
}

TEST(SeamCell, IsBoundedByTheDifferenceOfTheTwoSectionsInAllPatterns) {
  test::Random random(kCellSeed);
  for (unsigned pattern = 0; pattern < kSeamPatterns; ++pattern) {
    for (int round = 0; round < test::rounds(8); ++round) {
      const Cell cell = random_cell(pattern, random);
      ASSERT_EQ(cell.pattern(), pattern);
      const auto places = cell.places();
      const Chain strip = in_steps(outline_of(seam_triangles(pattern, places), places));
      const Chain difference = sum(outline_of(coarse_rock(cell), 1), outline_of(fine_rock(cell), -1));
      ASSERT_EQ(strip, difference) << "pattern " << pattern << ", round " << round << ", seed " << kCellSeed;
    }
  }
}

TEST(SeamCell, UsesEverySegmentOfBothContoursOnceAndEveryDiagonalTwice) {
  test::Random random(kCellSeed);
  for (unsigned pattern = 0; pattern < kSeamPatterns; ++pattern) {
    for (int round = 0; round < test::rounds(10); ++round) {
      const Cell cell = random_cell(pattern, random);
      const auto places = cell.places();
      const SeamTriangles triangles = seam_triangles(pattern, places);
      std::map<std::pair<int, int>, int> uses;
      for (std::size_t t = 0; t < triangles.count; ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
          const int from = triangles.crossings[3 * t + i];
          const int to = triangles.crossings[3 * t + (i + 1) % 3];
          ASSERT_NE(places[static_cast<std::size_t>(from)], places[static_cast<std::size_t>(to)]);
          ++uses[{from, to}];
        }
      }
      for (const auto& [edge, times] : uses) ASSERT_EQ(times, 1) << "an edge is walked twice in one direction";
    }
  }
}

TEST(SeamCell, IsEmptyWhereBothSectionsAreTheSame) {
  test::Random random(kCellSeed);
  EXPECT_EQ(seam_triangles(0, {}).count, 0U);
  EXPECT_EQ(seam_triangles(kSeamPatterns - 1, {}).count, 0U);
  // One corner of rock, cut off at one place by both: nothing lies between.
  Cell cell = random_cell(1, random);
  cell.sides[0] = 20;
  cell.fine_u[0] = 40;
  cell.sides[2] = 11;
  cell.fine_v[0] = 22;
  EXPECT_EQ(seam_triangles(1, cell.places()).count, 0U);
}

TEST(SeamCell, CutsWithTheLeastArea) {
  // A fine contour that dips below a straight coarse one: the triangle between the two and nothing else.
  Cell cell;
  cell.rock = {true, true, true, true, true, true, false, false, false};
  cell.fine_u.fill(32);
  cell.fine_v.fill(32);
  cell.fine_v[4] = 2;  // on the middle line
  cell.sides = {32, 32, 48, 48};
  const auto places = cell.places();
  const SeamTriangles triangles = seam_triangles(cell.pattern(), places);
  ASSERT_EQ(triangles.count, 1U);
  int area2 = 0;
  const auto at = [&](std::size_t i) { return places[triangles.crossings[i]]; };
  const glm::ivec2 ab = at(1) - at(0);
  const glm::ivec2 ac = at(2) - at(0);
  area2 = ab.x * ac.y - ab.y * ac.x;
  EXPECT_EQ(area2, kSide * 30) << "counter-clockwise: coarse rock against fine air";
}

}  // namespace
}  // namespace talus
