#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "server/cache/column_memo.hpp"
#include "server/cache/memory_cache.hpp"

namespace talus::server {
namespace {

PayloadName name_of(std::int32_t x, PayloadFormat format = PayloadFormat::kDraco) {
  PayloadName name;
  name.format = format;
  name.key = {3, x, 1, 2};
  return name;
}

PayloadRef payload_of(std::size_t bytes) {
  return std::make_shared<const ChunkPayload>(ChunkPayload{ChunkKind::kMesh, std::vector<std::byte>(bytes)});
}

TEST(MemoryCache, GivesBackTheSamePayloadItWasGiven) {
  MemoryCache cache(1 << 20);
  const PayloadRef payload = payload_of(100);
  cache.store(name_of(1), payload);
  EXPECT_EQ(cache.load(name_of(1)), payload);
  EXPECT_EQ(cache.load(name_of(2)), nullptr);
}

TEST(MemoryCache, KeepsFormatsAndOriginsApart) {
  MemoryCache cache(1 << 20);
  PayloadName far = name_of(1, PayloadFormat::kGlb);
  far.origin = {1, 0, 0};
  cache.store(name_of(1, PayloadFormat::kGlb), payload_of(1));
  EXPECT_EQ(cache.load(name_of(1)), nullptr);
  EXPECT_EQ(cache.load(far), nullptr);
}

TEST(MemoryCache, TakesTheTwoZerosOfAnOriginForOne) {
  MemoryCache cache(1 << 20);
  PayloadName negative = name_of(1, PayloadFormat::kGlb);
  negative.origin = {-0.0, 0, 0};
  cache.store(name_of(1, PayloadFormat::kGlb), payload_of(1));
  EXPECT_NE(cache.load(negative), nullptr);
}

TEST(MemoryCache, NeverHoldsMoreThanItsBytesHoweverMuchIsStored) {
  MemoryCache cache(1 << 20);
  for (std::int32_t i = 0; i < 5000; ++i) {
    cache.store(name_of(i), payload_of(static_cast<std::size_t>(i % 3000)));
    ASSERT_LE(cache.bytes(), cache.bytes_max());
  }
  EXPECT_GT(cache.bytes(), cache.bytes_max() / 2);
}

TEST(MemoryCache, CountsEntriesWithoutBytesByTheirOverhead) {
  MemoryCache cache(1 << 20);
  for (std::int32_t i = 0; i < 100'000; ++i) cache.store(name_of(i), payload_of(0));
  EXPECT_LE(cache.entries(), (std::size_t{1} << 20) / kCacheEntryOverheadBytes);
}

TEST(MemoryCache, ForgetsTheLongestUnusedFirst) {
  MemoryCache cache(16 * 10'000);
  cache.store(name_of(0), payload_of(2000));
  std::vector<bool> was_kept;
  for (std::int32_t i = 1; i < 200; ++i) {
    cache.store(name_of(i), payload_of(2000));
    EXPECT_NE(cache.load(name_of(0)), nullptr) << "used after every store, so never the longest unused, at " << i;
  }
  EXPECT_EQ(cache.load(name_of(1)), nullptr);
}

TEST(MemoryCache, SaysWhatBecameOfItsEntries) {
  MemoryCache cache(16 * 10'000);
  EXPECT_EQ(cache.load(name_of(0)), nullptr);
  for (std::int32_t i = 0; i < 500; ++i) cache.store(name_of(i), payload_of(2000));
  const std::size_t kept = cache.entries();
  EXPECT_EQ(cache.totals().misses, 1U);
  EXPECT_EQ(cache.totals().hits, 0U);
  EXPECT_EQ(cache.totals().stored, 500U);
  EXPECT_EQ(cache.totals().evicted, 500U - kept);
  EXPECT_EQ(cache.totals().recalled, 0U);
  // The newest are there, and those that left last are remembered by name.
  for (std::int32_t i = 500; i-- > 0;) {
    if (cache.load(name_of(i)) == nullptr) cache.store(name_of(i), payload_of(2000));
  }
  EXPECT_GT(cache.totals().hits, 0U);
  EXPECT_GT(cache.totals().recalled, 0U);
}

TEST(MemoryCache, CountsAReplacedEntryOnce) {
  MemoryCache cache(1 << 20);
  for (int i = 0; i < 10; ++i) cache.store(name_of(1), payload_of(1000));
  EXPECT_EQ(cache.entries(), 1U);
  EXPECT_LT(cache.bytes(), 2000U);
}

TEST(MemoryCache, LeavesOutWhatWouldFillAShardAlone) {
  MemoryCache cache(16 * 1000);
  cache.store(name_of(1), payload_of(5000));
  EXPECT_EQ(cache.entries(), 0U);
}

TEST(MemoryCache, IsUsedByManyThreadsAtOnce) {
  MemoryCache cache(1 << 18);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&cache, t] {
      for (std::int32_t i = 0; i < 2000; ++i) {
        cache.store(name_of((i * 7 + t) % 500), payload_of(static_cast<std::size_t>(i % 900)));
        cache.load(name_of(i % 500));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(cache.bytes(), cache.bytes_max());
}

TEST(ColumnMemo, GivesBackEveryValueAndForgetsTheLongestUnused) {
  ColumnMemo memo(2);
  ColumnBlock block;
  block.height_m = {1, 2, 3};
  block.height_high_m = 9;
  block.workspace.arrays = {5};
  memo.store({0, 0, 1, 1}, block);
  EXPECT_EQ(block.workspace.arrays.size(), 1U) << "working memory stays with its owner";
  memo.store({0, 0, 2, 2}, block);
  ColumnBlock out;
  out.workspace.arrays = {7, 7};
  EXPECT_TRUE(memo.load({0, 0, 1, 1}, out));
  EXPECT_EQ(out.height_m, block.height_m);
  EXPECT_EQ(out.height_high_m, 9);
  EXPECT_EQ(out.workspace.arrays.size(), 2U);
  memo.store({0, 1, 1, 1}, block);
  EXPECT_FALSE(memo.load({0, 0, 2, 2}, out));
  EXPECT_TRUE(memo.load({0, 0, 1, 1}, out));
  EXPECT_EQ(memo.blocks(), 2U);
}

}  // namespace
}  // namespace talus::server
