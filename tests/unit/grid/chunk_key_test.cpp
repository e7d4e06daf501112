#include "core/grid/chunk_key.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/grid/octree_order.hpp"

namespace talus {
namespace {

TEST(ChunkKey, IsTheChildOfItsParentOnBothSidesOfZero) {
  for (const std::int32_t c : {-kChunkLimit, -3, -2, -1, 0, 1, 2, kChunkLimit}) {
    const ChunkKey key{3, c, -c, c / 2};
    const auto children = children_of(parent_of(key));
    EXPECT_NE(std::ranges::find(children, key), children.end()) << c;
  }
}

TEST(ChunkKey, FillsItsParentExactly) {
  const ChunkKey parent{5, -7, 2, 11};
  const BoxWorld whole = box_of(parent, 32, 0.5);
  double volume = 0;
  for (const ChunkKey& child : children_of(parent)) {
    const BoxWorld part = box_of(child, 32, 0.5);
    const glm::dvec3 edge = part.high - part.low;
    volume += edge.x * edge.y * edge.z;
    EXPECT_GE(part.low.x, whole.low.x);
    EXPECT_LE(part.high.z, whole.high.z);
  }
  const glm::dvec3 edge = whole.high - whole.low;
  EXPECT_EQ(volume, edge.x * edge.y * edge.z);
}

/// Every node of the tree below `key`, in the order in which a walk meets them.
void walk(const ChunkKey& key, std::vector<ChunkKey>& out) {
  out.push_back(key);
  if (key.lod == 0) return;
  for (const ChunkKey& child : children_of(key)) walk(child, out);
}

TEST(OctreeOrder, IsTheOrderOfAWalkDepthFirst) {
  for (const ChunkKey& root : {ChunkKey{3, 0, 0, 0}, ChunkKey{3, -1, -1, -1}, ChunkKey{3, 5, -7, kChunkLimit / 8}}) {
    std::vector<ChunkKey> met;
    walk(root, met);
    for (std::size_t i = 0; i < met.size(); i += 7) {
      for (std::size_t j = 0; j < met.size(); ++j)
        ASSERT_EQ(is_before_in_octree(met[i], met[j]), i < j) << i << ' ' << j;
    }
  }
  EXPECT_TRUE(is_before_in_octree({3, -1, 0, 0}, {0, 0, 0, 0}));
  EXPECT_TRUE(is_before_in_octree({kLodMax, -kChunkLimit, 0, 0}, {kLodMax, kChunkLimit, 0, 0}));
}

TEST(ChunkKey, IsValidUpToTheLimitAndNotBeyond) {
  EXPECT_TRUE(is_valid({kLodMax, kChunkLimit, -kChunkLimit, 0}));
  EXPECT_FALSE(is_valid({0, kChunkLimit + 1, 0, 0}));
  EXPECT_FALSE(is_valid({0, 0, 0, -kChunkLimit - 1}));
  EXPECT_FALSE(is_valid({kLodMax + 1, 0, 0, 0}));
  EXPECT_FALSE(is_valid({-1, 0, 0, 0}));
}

TEST(ChunkKey, CornersOfTheFurthestChunkAreExact) {
  const glm::i64vec3 corner = corner_voxel({kLodMax, kChunkLimit, -kChunkLimit, 1}, 32);
  EXPECT_EQ(corner.x, std::int64_t{kChunkLimit} * 32 * 4096);
  EXPECT_EQ(static_cast<std::int64_t>(static_cast<double>(corner.x)), corner.x);
  EXPECT_EQ(corner.y, -corner.x);
}

}  // namespace
}  // namespace talus
