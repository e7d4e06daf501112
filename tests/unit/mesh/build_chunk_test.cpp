#include "core/mesh/build_chunk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kChunkSeed = 31;

using test::random_surface_key;

bool same_mesh(const ChunkMesh& a, const ChunkMesh& b) {
  const auto bytes = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return bytes(a.positions, b.positions) && bytes(a.normals, b.normals) && bytes(a.materials, b.materials) &&
         bytes(a.ridges, b.ridges) && bytes(a.indices, b.indices);
}

TEST(BuildChunk, GivesTheSameMeshWhateverWasBuiltBefore) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  ChunkScratch used;
  ChunkMesh again;
  for (int round = 0; round < test::rounds(60); ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, kLodMax)));
    ChunkScratch fresh;
    ChunkMesh first;
    const ChunkKind kind = build_chunk(world, key, fresh, first);
    EXPECT_EQ(build_chunk(world, key, used, again), kind);
    ASSERT_TRUE(same_mesh(first, again)) << "seed " << kChunkSeed << ", round " << round;
  }
}

TEST(BuildChunk, GivesTheSameBitsOnEveryTarget) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  for (int round = 0; round < 8; ++round) {
    const ChunkKey key = random_surface_key(world, random, round);
    ChunkScratch scratch;
    ChunkMesh best;
    build_chunk(world, key, scratch, best);
    const int targets = test::for_each_simd_target([&](const char* target) {
      ChunkMesh mesh;
      build_chunk(world, key, scratch, mesh);
      EXPECT_TRUE(same_mesh(mesh, best)) << target;
    });
    EXPECT_GE(targets, 2);
  }
}

TEST(BuildChunk, PutsNoVertexTwiceAndNoTriangleFlat) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  std::size_t triangles = 0;
  std::size_t facing_up = 0;
  for (int round = 0; round < test::rounds(60); ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, 8)));
    if (build_chunk(world, key, scratch, mesh) != ChunkKind::kMesh) continue;
    std::map<std::array<int, 3>, int> places;
    for (const auto& p : mesh.positions) {
      EXPECT_EQ(++places[(std::array<int, 3>{p.x, p.y, p.z})], 1);
      EXPECT_LE(std::max({p.x, p.y, p.z}), 32 * kStepsPerCell);
    }
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      const glm::i64vec3 a(mesh.positions[mesh.indices[t]]);
      const glm::i64vec3 u = glm::i64vec3(mesh.positions[mesh.indices[t + 1]]) - a;
      const glm::i64vec3 v = glm::i64vec3(mesh.positions[mesh.indices[t + 2]]) - a;
      const glm::i64vec3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
      ASSERT_TRUE(n.x != 0 || n.y != 0 || n.z != 0) << "a triangle without area";
      // Counter-clockwise seen from the air: most triangles of open country face up.
      facing_up += n.y >= 0 ? 1U : 0U;
    }
    triangles += mesh.triangles();
  }
  EXPECT_GT(triangles, static_cast<std::size_t>(test::rounds(50'000))) << "too little was looked at";
  EXPECT_GT(facing_up, triangles / 100 * 95);
}

TEST(BuildChunk, SaysAirAndRockWhereThereIsNoSurface) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < test::rounds(40); ++round) {
    ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, 5)));
    key.y += 200;
    EXPECT_EQ(build_chunk(world, key, scratch, mesh), ChunkKind::kAir);
    key.y -= 400;
    EXPECT_EQ(build_chunk(world, key, scratch, mesh), ChunkKind::kRock);
    EXPECT_TRUE(mesh.indices.empty());
  }
}

TEST(BuildChunk, PointsNormalsAwayFromRock) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  std::size_t triangles = 0;
  std::size_t against = 0;
  for (int round = 0; round < test::rounds(20); ++round) {
    if (build_chunk(world, random_surface_key(world, random, 0), scratch, mesh) != ChunkKind::kMesh) continue;
    for (const auto& n : mesh.normals) ASSERT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0f, 1e-5f);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      const auto corner = [&](std::size_t c) { return glm::vec3(mesh.positions[mesh.indices[t + c]]); };
      const glm::vec3 face = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      const glm::vec3 normals =
          mesh.normals[mesh.indices[t]] + mesh.normals[mesh.indices[t + 1]] + mesh.normals[mesh.indices[t + 2]];
      against += glm::dot(face, normals) < 0.0f ? 1U : 0U;
    }
    triangles += mesh.triangles();
  }
  // Where a ledge is thinner than a voxel the field's gradient points across it.
  EXPECT_LT(against, triangles / 200) << "of " << triangles;
}

TEST(BuildChunk, ClosesItsSurfaceButForTheChunksFaces) {
  const WorldFunction world{Manifest()};
  test::Random random(kChunkSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  int edges_seen = 0;
  for (int round = 0; round < test::rounds(40); ++round) {
    if (build_chunk(world, random_surface_key(world, random, static_cast<int>(random.whole(0, 6))), scratch, mesh) !=
        ChunkKind::kMesh)
      continue;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
      for (std::size_t c = 0; c < 3; ++c) ++edges[{mesh.indices[t + c], mesh.indices[t + (c + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << "an edge used twice in one direction";
      if (edges.contains({edge.second, edge.first})) continue;
      const glm::u16vec3 a = mesh.positions[edge.first];
      const glm::u16vec3 b = mesh.positions[edge.second];
      bool on_face = false;
      for (int axis = 0; axis < 3; ++axis)
        on_face = on_face || (a[axis] == b[axis] && (a[axis] == 0 || a[axis] == 32 * kStepsPerCell));
      ASSERT_TRUE(on_face) << "a hole inside the chunk, seed " << kChunkSeed << ", round " << round;
    }
    edges_seen += static_cast<int>(edges.size());
  }
  EXPECT_GT(edges_seen, test::rounds(50'000));
}

}  // namespace
}  // namespace talus
