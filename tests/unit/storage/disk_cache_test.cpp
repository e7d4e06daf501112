#include "server/storage/disk_cache.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "server/observe/log.hpp"
#include "server/storage/sqlite.hpp"
#include "tests/support/scratch_folder.hpp"

namespace talus::server {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMiB = 1024 * 1024;

/// Time that a test moves.
class HandClock final : public Clock {
 public:
  Instant now() const override { return Instant{}; }
  std::int64_t unix_seconds() const override { return seconds; }
  std::int64_t seconds = 1'000'000;
};

class DiskCacheTest : public testing::Test {
 protected:
  DiskCacheTest() { set_log_level(LogLevel::kOff); }

  std::expected<std::unique_ptr<DiskCache>, std::string> try_open(std::size_t bytes_max = 64 * kMiB) {
    return DiskCache::open({folder.path().string(), bytes_max, 4}, clock, metrics);
  }
  std::unique_ptr<DiskCache> open(std::size_t bytes_max = 64 * kMiB) {
    auto cache = try_open(bytes_max);
    EXPECT_TRUE(cache.has_value()) << cache.error();
    return cache ? std::move(*cache) : nullptr;
  }
  /// Runs SQL behind the cache's back.
  void tamper(const std::string& sql) {
    auto database = Database::open(folder / "chunks.sqlite", Database::Mode::kReadWrite);
    ASSERT_TRUE(database.has_value());
    const auto done = database->execute(sql.c_str());
    ASSERT_TRUE(done.has_value()) << done.error().message;
  }
  std::uint64_t count(Count which) const { return metrics.value(which); }

  const test::ScratchFolder folder;
  HandClock clock;
  Metrics metrics;
};

StoredBytes payload(std::size_t seed, std::size_t size = 5000) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>((i * 31 + seed * 7 + (i >> 7) * seed) & 0xFF);
  return std::make_shared<const std::vector<std::byte>>(std::move(out));
}

std::string name_of(std::size_t i) {
  return "chunk " + std::to_string(i);
}

TEST_F(DiskCacheTest, GivesBackAfterARestartWhatWasStoredByteForByte) {
  {
    const auto cache = open();
    for (std::size_t i = 0; i < 200; ++i) {
      cache->store(name_of(i), static_cast<std::uint8_t>(i % 3), payload(i, i * 50));
    }
  }
  const auto cache = open();
  for (std::size_t i = 0; i < 200; ++i) {
    const auto loaded = cache->load(name_of(i), i % 4);
    ASSERT_TRUE(loaded.has_value()) << i;
    EXPECT_EQ(loaded->kind, i % 3);
    EXPECT_EQ(loaded->bytes, *payload(i, i * 50));
  }
  EXPECT_FALSE(cache->load("never stored", 0).has_value());
  EXPECT_EQ(count(Count::kDiskHit), 200U);
  EXPECT_EQ(count(Count::kDiskMiss), 1U);
  EXPECT_EQ(count(Count::kDiskStored), 200U);
}

TEST_F(DiskCacheTest, CommitsInBatchesWithoutBeingAsked) {
  const auto cache = open();
  for (std::size_t i = 0; i < 63; ++i) cache->store(name_of(i), 0, payload(i));
  EXPECT_EQ(count(Count::kDiskStored), 0U);
  cache->store(name_of(63), 0, payload(63));
  EXPECT_EQ(count(Count::kDiskStored), 64U);
  EXPECT_EQ(cache->pending_bytes(), 0U);
}

TEST_F(DiskCacheTest, CountsABadEntryAsAMissUntilItIsStoredAnew) {
  for (const char* damage :
       {"UPDATE entry SET payload = zeroblob(length(payload))", "UPDATE entry SET payload = substr(payload, 1, 100)",
        "UPDATE entry SET head = x'00'", "UPDATE entry SET payload = 'text', head = 7"}) {
    SCOPED_TRACE(damage);
    const auto before = count(Count::kDiskBad);
    const auto cache = open();
    cache->store("a", 2, payload(1));
    cache->flush();
    ASSERT_TRUE(cache->load("a", 0).has_value());
    tamper(damage);
    EXPECT_FALSE(cache->load("a", 0).has_value());
    EXPECT_EQ(count(Count::kDiskBad), before + 1);
    cache->store("a", 2, payload(1));
    cache->flush();
    const auto again = cache->load("a", 0);
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->bytes, *payload(1));
  }
}

TEST_F(DiskCacheTest, NeverGivesAnEntryToAnotherNameThatSharesItsPlace) {
  const auto cache = open();
  cache->store("a", 2, payload(1));
  cache->flush();
  tamper("UPDATE entry SET place = " + std::to_string(entry_place("b")));
  EXPECT_FALSE(cache->load("b", 0).has_value());
  EXPECT_EQ(count(Count::kDiskBad), 1U);
}

TEST_F(DiskCacheTest, StaysWithinItsBytesAndForgetsWhatWasLongestUnused) {
  constexpr std::size_t kMax = 2 * kMiB;
  const auto cache = open(kMax);
  for (std::size_t i = 0; i < 2000; ++i) {
    clock.seconds += 10;
    cache->store(name_of(i), 2, payload(i));
    if (i % 100 == 0) {
      cache->flush();
      EXPECT_LE(cache->bytes(), kMax);
      // Used again and again: never among the longest unused.
      EXPECT_TRUE(cache->load(name_of(0), 0).has_value()) << i;
      clock.seconds += 4000;
    }
  }
  cache->flush();
  EXPECT_LE(cache->bytes(), kMax);
  EXPECT_LE(fs::file_size(folder / "chunks.sqlite"), kMax + kMiB);
  EXPECT_LE(fs::file_size(folder / "chunks.sqlite-wal"), 9 * kMiB);
  EXPECT_GT(count(Count::kDiskEvicted), 1000U);
  EXPECT_TRUE(cache->load(name_of(1999), 0).has_value());
  EXPECT_FALSE(cache->load(name_of(1), 0).has_value());
}

TEST_F(DiskCacheTest, ShrinksWhenItsBoundIsLowered) {
  {
    const auto cache = open();
    for (std::size_t i = 0; i < 2000; ++i) cache->store(name_of(i), 2, payload(i));
  }
  ASSERT_GT(fs::file_size(folder / "chunks.sqlite"), 8 * kMiB);
  {
    const auto cache = open(kMiB);
    for (std::size_t i = 0; i < 640; ++i) cache->store(name_of(i + 5000), 2, payload(i));
    cache->flush();
    EXPECT_LE(cache->bytes(), kMiB);
  }
  EXPECT_LE(fs::file_size(folder / "chunks.sqlite"), 2 * kMiB);
}

TEST_F(DiskCacheTest, BeginsAnewWhenTheFileIsNotOneOfOurs) {
  fs::create_directories(folder.path());
  std::ofstream(folder / "chunks.sqlite") << std::string(20000, 'x');
  {
    const auto cache = open();
    EXPECT_EQ(count(Count::kDiskFault), 1U);
    cache->store("a", 2, payload(1));
  }
  tamper("PRAGMA user_version = 999");
  {
    const auto cache = open();
    EXPECT_FALSE(cache->load("a", 0).has_value()) << "tables of another edition";
    cache->store("a", 2, payload(1));
  }
  EXPECT_TRUE(open()->load("a", 0).has_value());
}

TEST_F(DiskCacheTest, MayBeDeletedWhileItIsUsed) {
  {
    const auto cache = open();
    cache->store("a", 2, payload(1));
    cache->flush();
    fs::remove_all(folder.path());
    for (std::size_t i = 0; i < 200; ++i) cache->store(name_of(i), 2, payload(i));
    cache->flush();
  }
  const auto cache = open();
  cache->store("b", 2, payload(2));
  cache->flush();
  EXPECT_TRUE(cache->load("b", 0).has_value());
}

TEST_F(DiskCacheTest, GivesUpAFileThatIsOverwrittenUnderItAndBeginsAnewAtTheNextStart) {
  {
    const auto cache = open(64 * kMiB);
    for (std::size_t i = 0; i < 640; ++i) cache->store(name_of(i), 2, payload(i));
  }
  {
    const auto cache = open(64 * kMiB);
    {
      std::fstream file(folder / "chunks.sqlite", std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(4096);
      file << std::string(2 * kMiB, '\xA5');
    }
    for (std::size_t i = 0; i < 640; ++i) {
      const auto loaded = cache->load(name_of(i), 0);
      EXPECT_TRUE(!loaded || loaded->bytes == *payload(i));
      cache->store(name_of(i), 2, payload(i));
    }
    EXPECT_GT(count(Count::kDiskFault) + count(Count::kDiskBad), 0U);
  }
  const auto cache = open();
  cache->store("b", 2, payload(2));
  cache->flush();
  EXPECT_TRUE(cache->load("b", 0).has_value());
}

TEST_F(DiskCacheTest, RefusesAFolderThatAnotherServerUsesOrThatCannotBe) {
  const auto cache = open();
  const auto second = try_open();
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().find("another server"), std::string::npos);
  const auto nowhere = DiskCache::open({"/proc/no such place", kMiB, 1}, clock, metrics);
  EXPECT_FALSE(nowhere.has_value());
}

TEST_F(DiskCacheTest, IsReadAndWrittenByManyThreadsAtOnce) {
  const auto cache = open(4 * kMiB);
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < 600; ++i) {
        const std::size_t which = (i * 13 + t * 7) % 900;
        if (const auto loaded = cache->load(name_of(which), t)) {
          wrong += loaded->bytes == *payload(which) ? 0 : 1;
        } else {
          cache->store(name_of(which), 2, payload(which));
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(count(Count::kDiskFault), 0U);
  EXPECT_EQ(count(Count::kDiskBad), 0U);
  EXPECT_GT(count(Count::kDiskHit), 0U);
}

}  // namespace
}  // namespace talus::server
