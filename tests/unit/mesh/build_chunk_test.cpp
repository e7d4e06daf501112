#include "core/mesh/build_chunk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSeed = 31;

using testing::random_surface_key;

bool same_mesh(const ChunkMesh& a, const ChunkMesh& b) {
  const auto bytes = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return bytes(a.positions, b.positions) && bytes(a.normals, b.normals) && bytes(a.materials, b.materials) &&
         bytes(a.ridges, b.ridges) && bytes(a.indices, b.indices);
}

TEST(BuildChunk, GivesTheSameMeshWhateverWasBuiltBefore) {
  const WorldFunction world{Manifest()};
  testing::Random random(kSeed);
  ChunkScratch used;
  ChunkMesh again;
  for (int round = 0; round < 60; ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, kLodMax)));
    ChunkScratch fresh;
    ChunkMesh first;
    const ChunkKind kind = build_chunk(world, key, fresh, first);
    EXPECT_EQ(build_chunk(world, key, used, again), kind);
    ASSERT_TRUE(same_mesh(first, again)) << "seed " << kSeed << ", round " << round;
  }
}

TEST(BuildChunk, GivesTheSameBitsOnEveryTarget) {
  const WorldFunction world{Manifest()};
  testing::Random random(kSeed);
  for (int round = 0; round < 8; ++round) {
    const ChunkKey key = random_surface_key(world, random, round);
    ChunkScratch scratch;
    ChunkMesh best;
    build_chunk(world, key, scratch, best);
    const int targets = testing::for_each_simd_target([&](const char* target) {
      ChunkMesh mesh;
      build_chunk(world, key, scratch, mesh);
      EXPECT_TRUE(same_mesh(mesh, best)) << target;
    });
    EXPECT_GE(targets, 2);
  }
}

TEST(BuildChunk, PutsNoVertexTwiceAndNoTriangleFlat) {
  const WorldFunction world{Manifest()};
  testing::Random random(kSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  std::size_t triangles = 0;
  for (int round = 0; round < 60; ++round) {
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
      // Heightfield terrain: every triangle faces up, which is what counter-clockwise seen from the air means.
      ASSERT_GE(n.y, 0);
    }
    triangles += mesh.triangles();
  }
  EXPECT_GT(triangles, 50'000U) << "too little was looked at";
}

TEST(BuildChunk, SaysAirAndRockWhereThereIsNoSurface) {
  const WorldFunction world{Manifest()};
  testing::Random random(kSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < 40; ++round) {
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
  testing::Random random(kSeed);
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < 20; ++round) {
    if (build_chunk(world, random_surface_key(world, random, 0), scratch, mesh) != ChunkKind::kMesh) continue;
    for (const auto& n : mesh.normals) {
      ASSERT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0f, 1e-5f);
      ASSERT_GT(n.y, 0.0f);
    }
  }
}

}  // namespace
}  // namespace talus
