// The bytes of a chunk depend on its key alone: not on threads, order, or what a thread built before.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kPuritySeed = 17;
using Bytes = std::vector<std::byte>;

Bytes bytes_of(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch) {
  ChunkMesh mesh;
  if (build_chunk(world, key, scratch, mesh) != ChunkKind::kMesh) return {};
  return protocol::encode_draco(mesh, protocol::mesh_lattice(key, world.cells(), world.voxel_m())).value();
}

std::vector<ChunkKey> keys_of(const WorldFunction& world) {
  test::Random random(kPuritySeed);
  std::vector<ChunkKey> keys;
  for (int n = 0; n < 96; ++n) keys.push_back(test::random_surface_key(world, random, n % 9));
  return keys;
}

TEST(Purity, SameBytesForAnyNumberOfThreadsInAnyOrder) {
  const WorldFunction world{Manifest()};
  const auto keys = keys_of(world);
  std::vector<Bytes> alone(keys.size());
  for (std::size_t n = 0; n < keys.size(); ++n) {
    ChunkScratch scratch;
    alone[n] = bytes_of(world, keys[n], scratch);
  }
  EXPECT_GT(std::ranges::count_if(alone, [](const Bytes& b) { return !b.empty(); }), 60);
  for (const std::size_t threads : {1U, 2U, 8U}) {
    std::vector<Bytes> together(keys.size());
    std::atomic<std::size_t> next{0};
    {
      std::vector<std::jthread> pool;
      for (std::size_t t = 0; t < threads; ++t) {
        pool.emplace_back([&] {
          ChunkScratch scratch;
          for (std::size_t n = next++; n < keys.size(); n = next++) {
            // 53 and 96 have no common factor: every key once, in an order far from the first.
            const std::size_t at = (n * 53 + threads) % keys.size();
            together[at] = bytes_of(world, keys[at], scratch);
          }
        });
      }
    }
    EXPECT_EQ(together, alone) << threads << " threads";
  }
}

TEST(Purity, SameBytesOnEverySimdTarget) {
  const WorldFunction world{Manifest()};
  const auto keys = keys_of(world);
  ChunkScratch scratch;
  std::vector<Bytes> best;
  for (std::size_t n = 0; n < 18; ++n) best.push_back(bytes_of(world, keys[n], scratch));
  const int targets = test::for_each_simd_target([&](const char* target) {
    for (std::size_t n = 0; n < best.size(); ++n) EXPECT_EQ(bytes_of(world, keys[n], scratch), best[n]) << target;
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
