#include "core/mesh/seam_strip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/mesh/build_chunk.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kStripSeed = 77;

/// A vertex with all that travels with it, in steps of the finer lattice.
using FullVertex = std::array<std::int64_t, 8>;

FullVertex full(const ChunkMesh& mesh, std::size_t v, int scale, const glm::ivec3& shift) {
  const glm::ivec3 p = scale * glm::ivec3(mesh.positions[v]) + shift;
  const auto bits = [](float f) { return static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(f)); };
  const glm::vec3& n = mesh.normals[v];
  return {p.x, p.y, p.z, bits(n.x), bits(n.y), bits(n.z), mesh.materials[v], mesh.ridges[v]};
}

/// Edges with a direction, by place alone; how often each is walked, less how often backwards.
using Place = std::array<std::int64_t, 3>;
using FaceEdges = std::map<std::pair<Place, Place>, int>;

Place place(const ChunkMesh& mesh, std::size_t v, int scale, const glm::ivec3& shift) {
  const FullVertex f = full(mesh, v, scale, shift);
  return {f[0], f[1], f[2]};
}

/// Adds the edges of `mesh` that lie in the plane where coordinate `axis` is `at`.
void add_edges(FaceEdges& chain, const ChunkMesh& mesh, int scale, const glm::ivec3& shift, int axis, int at) {
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Place from = place(mesh, mesh.indices[i], scale, shift);
    const Place to = place(mesh, mesh.indices[i - i % 3 + (i + 1) % 3], scale, shift);
    const auto a = static_cast<std::size_t>(axis);
    if (from[a] != at || to[a] != at) continue;
    from < to ? ++chain[{from, to}] : --chain[{to, from}];
  }
  std::erase_if(chain, [](const auto& entry) { return entry.second == 0; });
}

struct Neighbourhood {
  ChunkMesh coarse;
  std::array<ChunkMesh, 4> fine;
  std::array<glm::ivec3, 4> fine_shift;
  ChunkMesh strip;
};

Neighbourhood neighbourhood(const WorldFunction& world, const ChunkKey& key, ChunkFace face) {
  Neighbourhood out;
  ChunkScratch scratch;
  StripScratch strip_scratch;
  build_chunk(world, key, scratch, out.coarse);
  const auto finer = finer_across(key, face);
  for (std::size_t i = 0; i < finer.size(); ++i) {
    build_chunk(world, finer[i], scratch, out.fine[i]);
    out.fine_shift[i] = glm::ivec3(finer[i].x - 2 * key.x, finer[i].y - 2 * key.y, finer[i].z - 2 * key.z) *
                        world.cells() * kStepsPerCell;
  }
  build_strip(
      world, key, face, [&](const ChunkKey& of, ColumnBlock& block) { world.columns(chunk_columns(world, of), block); },
      strip_scratch, out.strip);
  return out;
}

class SeamStrip : public ::testing::Test {
 protected:
  template <class Body>
  void for_random_faces(int rounds, Body body) {
    test::Random random(kStripSeed);
    for (int round = 0; round < rounds; ++round) {
      const ChunkKey key = test::random_surface_key(world_, random, static_cast<int>(random.whole(1, 8)));
      const auto face = kAllChunkFaces[static_cast<std::size_t>(round) % kChunkFaces];
      SCOPED_TRACE(::testing::Message() << "seed " << kStripSeed << ", round " << round << ": " << key.lod << '/'
                                        << key.x << '/' << key.y << '/' << key.z << '/'
                                        << kChunkFaceNames[static_cast<std::size_t>(face)]);
      body(key, face);
      if (HasFatalFailure()) return;
    }
  }

  const WorldFunction world_{Manifest()};
};

TEST_F(SeamStrip, ClosesEveryEdgeInsideItsFaceAndBetweenTheMeshes) {
  int strips = 0;
  std::size_t triangles = 0;
  for_random_faces(test::rounds(240), [&](const ChunkKey& key, ChunkFace face) {
    const Neighbourhood n = neighbourhood(world_, key, face);
    const int edge = 2 * world_.cells() * kStepsPerCell;
    const int axis = axis_of(face);
    const int at = is_high(face) ? edge : 0;
    FaceEdges chain;
    add_edges(chain, n.coarse, 2, {}, axis, at);
    for (std::size_t i = 0; i < 4; ++i) add_edges(chain, n.fine[i], 1, n.fine_shift[i], axis, at);
    add_edges(chain, n.strip, 1, {}, axis, at);
    // What is left lies on the sides of the face, where the strips around that edge of the chunk go on.
    for (const auto& [segment, times] : chain) {
      bool is_on_side = false;
      for (std::size_t side = 0; side < 3; ++side) {
        if (static_cast<int>(side) == axis) continue;
        const std::int64_t where = segment.first[side];
        is_on_side |= (where == 0 || where == edge) && segment.second[side] == where;
      }
      ASSERT_TRUE(is_on_side) << times << " times from " << segment.first[0] << ' ' << segment.first[1] << ' '
                              << segment.first[2] << " to " << segment.second[0] << ' ' << segment.second[1] << ' '
                              << segment.second[2];
    }
    strips += n.strip.triangles() > 0 ? 1 : 0;
    triangles += n.strip.triangles();
  });
  RecordProperty("triangles", static_cast<int>(triangles));
  EXPECT_GT(strips, test::rounds(80)) << "too few faces were crossed to prove anything";
}

TEST_F(SeamStrip, HasOnlyVerticesOfTheTwoMeshesWithTheirNormalsAndMaterials) {
  for_random_faces(test::rounds(60), [&](const ChunkKey& key, ChunkFace face) {
    const Neighbourhood n = neighbourhood(world_, key, face);
    std::map<FullVertex, int> known;
    for (std::size_t v = 0; v < n.coarse.positions.size(); ++v) ++known[full(n.coarse, v, 2, {})];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t v = 0; v < n.fine[i].positions.size(); ++v) ++known[full(n.fine[i], v, 1, n.fine_shift[i])];
    }
    for (std::size_t v = 0; v < n.strip.positions.size(); ++v) {
      ASSERT_TRUE(known.contains(full(n.strip, v, 1, {}))) << "vertex " << v << " is nobody's";
    }
  });
}

/// Counts the densities that a strip has sampled: all of a lattice's memory is made unset before.
class SampleCount {
 public:
  explicit SampleCount(StripScratch& scratch) : scratch_(scratch) {
    for (StripScratch::Lattice* lattice : {&scratch_.fine, &scratch_.coarse}) unset(*lattice);
  }
  /// Before the next part of a level face is sampled.
  void next_part() { sum_ += take(scratch_.fine); }
  std::size_t sum() {
    next_part();
    return sum_ += take(scratch_.coarse);
  }

 private:
  static constexpr std::size_t kFloatsMax = 80 * 80 * 80;  // more than any face's block has
  static void unset(StripScratch::Lattice& lattice) {
    lattice.density.assign(kFloatsMax, std::numeric_limits<float>::quiet_NaN());
  }
  static std::size_t take(StripScratch::Lattice& lattice) {
    const auto set = std::ranges::count_if(lattice.density, [](float value) { return !std::isnan(value); });
    unset(lattice);
    return static_cast<std::size_t>(set);
  }

  StripScratch& scratch_;
  std::size_t sum_ = 0;
};

/// Edges of the finer lattice on the face that the surface crosses: the length of its contour, in cells.
std::size_t contour_length(const Neighbourhood& n, ChunkFace face, int cells) {
  std::size_t out = 0;
  for (const ChunkMesh& mesh : n.fine) {
    for (const auto& position : mesh.positions) {
      // The finer chunk lies on the other side.
      if (position[axis_of(face)] == (is_high(face) ? 0 : cells * kStepsPerCell)) ++out;
    }
  }
  return out;
}

/// Samples of both lattices that a strip takes.
std::size_t samples_of_strip(const WorldFunction& world, const ChunkKey& key, ChunkFace face) {
  StripScratch scratch;
  SampleCount count(scratch);
  const ColumnLoader columns = [&](const ChunkKey& of, ColumnBlock& block) {
    if (of.lod < key.lod) count.next_part();
    world.columns(chunk_columns(world, of), block);
  };
  ChunkMesh strip;
  build_strip(world, key, face, columns, scratch, strip);
  return count.sum();
}

/// Whether the surface stays two cells away from the finer chunks across a face, going by the heights of their columns.
bool is_ruled_out(const WorldFunction& world, const ChunkKey& key, ChunkFace face) {
  ColumnBlock block;
  VolumeScratch volume;
  for (const ChunkKey& finer : finer_across(key, face)) {
    world.columns(chunk_columns(world, finer), block);
    world.volume(block, volume);
    const double away_m = 2.0 * static_cast<double>(block.grid.step_voxel) * world.voxel_m();
    const double low_m = static_cast<double>(block.rock_below_m) - away_m;
    const double high_m = static_cast<double>(block.air_above_m) + away_m;
    if (kind_by_heights(world, finer, low_m, high_m) == ChunkKind::kMesh) return false;
  }
  return true;
}

TEST_F(SeamStrip, SamplesTheLatticesOnlyNearTheContourAndNowhereWhereThereIsNone) {
  // A contour along a row of samples needs seven layers of it, three samples deep, of both lattices: 32 a cell.
  constexpr std::size_t kSamplesACell = 48;
  // Samples are taken 16 at a time; all of both lattices are 17,142.
  constexpr std::size_t kSamplesAnyway = 4'000;
  std::array<std::size_t, 3> lengths{};
  std::array<std::size_t, 3> samples{};
  int ruled_out = 0;
  for_random_faces(test::rounds(54), [&](const ChunkKey& key, ChunkFace face) {
    const std::size_t length = contour_length(neighbourhood(world_, key, face), face, world_.cells());
    const std::size_t taken = samples_of_strip(world_, key, face);
    EXPECT_LE(taken, kSamplesACell * length + kSamplesAnyway) << length << " cells long";
    lengths[static_cast<std::size_t>(axis_of(face))] += length;
    samples[static_cast<std::size_t>(axis_of(face))] += taken;
    for (const int up : {-2, 2}) {
      const ChunkKey other{key.lod, key.x, key.y + up, key.z};
      if (!is_ruled_out(world_, other, face)) continue;
      EXPECT_EQ(samples_of_strip(world_, other, face), 0U) << up << " chunks higher";
      ++ruled_out;
    }
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_GT(lengths[axis], static_cast<std::size_t>(test::rounds(200)))
        << "too few contours to judge by, axis " << axis;
    EXPECT_LE(samples[axis], kSamplesACell * lengths[axis] * 3 / 2) << "axis " << axis;
  }
  EXPECT_GT(ruled_out, test::rounds(60));
}

TEST_F(SeamStrip, IsTheSameOnEveryTargetAndWhateverWasBuiltBefore) {
  StripScratch used;
  const ColumnLoader columns = [&](const ChunkKey& of, ColumnBlock& block) {
    world_.columns(chunk_columns(world_, of), block);
  };
  for_random_faces(12, [&](const ChunkKey& key, ChunkFace face) {
    const ChunkMesh first = neighbourhood(world_, key, face).strip;
    test::for_each_simd_target([&](const char* target) {
      ChunkMesh again;
      build_strip(world_, key, face, columns, used, again);
      EXPECT_EQ(again.positions, first.positions) << target;
      EXPECT_EQ(again.normals, first.normals) << target;
      EXPECT_EQ(again.materials, first.materials) << target;
      EXPECT_EQ(again.indices, first.indices) << target;
    });
  });
}

}  // namespace
}  // namespace talus
