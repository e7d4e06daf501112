#include "server/world/chunk_service.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/observe/log.hpp"
#include "tests/support/gate.hpp"

namespace talus::server {
namespace {

/// Builds nothing until it is opened; counts; throws for LOD 12.
class HeldBuilder final : public ChunkBuilder {
 public:
  std::optional<ChunkPayload> build(const PayloadName& name, std::size_t, const CancelToken& token) override {
    std::unique_lock lock(mutex_);
    ++started;
    changed_.notify_all();
    changed_.wait(lock, [&] { return is_open_ || token.is_cancelled(); });
    if (token.is_cancelled()) {
      ++cancelled;
      return std::nullopt;
    }
    if (name.key.lod == 12) throw std::runtime_error("no such depth");
    ++built;
    return ChunkPayload{ChunkKind::kMesh, std::vector<std::byte>(10)};
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wake() { changed_.notify_all(); }
  void wait_for_start() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return started > 0; });
  }

  std::atomic<int> started = 0;
  std::atomic<int> built = 0;
  std::atomic<int> cancelled = 0;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
};

PayloadName name_of(std::int32_t x, std::int32_t lod = 0) {
  PayloadName name;
  name.key = {lod, x, 0, 0};
  return name;
}
const PayloadName kStubborn = name_of(5);

/// Does not come back from one chunk until it is opened, whatever its token says.
class StubbornBuilder final : public ChunkBuilder {
 public:
  std::optional<ChunkPayload> build(const PayloadName& name, std::size_t, const CancelToken&) override {
    if (name == kStubborn) gate_.wait();
    return ChunkPayload{ChunkKind::kMesh, std::vector<std::byte>(10)};
  }
  void open() { gate_.open(); }

 private:
  test::Gate gate_;
};

struct Bench {
  explicit Bench(std::size_t queued = 256) : pool({1, queued}) {}
  ~Bench() {
    builder.open();
    pool.stop();
  }
  SystemClock clock;
  Metrics metrics;
  MemoryCache cache{1 << 20};
  Worlds worlds;
  StoredChunks stored{worlds};
  JobPool pool;
  HeldBuilder builder;
  ChunkService service{cache, stored, pool, builder, clock, metrics};
};

constexpr Asker kHttp{1, Lane::kView, 0.0};
constexpr Asker kStream{2, Lane::kView, 0.0};

using Ticket = ChunkService::Ticket;

TEST(ChunkService, BuildsOnceHoweverManyAsk) {
  Bench bench;
  constexpr int kAskers = 20;
  std::atomic<int> answered = 0;
  std::promise<void> all;
  std::vector<ChunkService::Answer> answers;
  for (int i = 0; i < kAskers; ++i) {
    answers.push_back(bench.service.request(name_of(1), kHttp, [&](const ChunkResult& result) {
      EXPECT_TRUE(result.has_value());
      if (answered.fetch_add(1) + 1 == kAskers) all.set_value();
    }));
    EXPECT_TRUE(std::holds_alternative<Ticket>(answers.back()));
  }
  bench.builder.open();
  all.get_future().wait();
  EXPECT_EQ(bench.builder.built, 1);
  EXPECT_EQ(bench.metrics.value(Count::kChunkJoined), kAskers - 1);
  EXPECT_EQ(bench.service.flights(), 0U);
}

TEST(ChunkService, AnswersFromMemoryWithoutCallingBack) {
  Bench bench;
  bench.builder.open();
  std::promise<void> done;
  const auto first = bench.service.request(name_of(1), kHttp, [&](const ChunkResult&) { done.set_value(); });
  done.get_future().wait();
  const auto second =
      bench.service.request(name_of(1), kHttp, [](const ChunkResult&) { ADD_FAILURE() << "called back"; });
  EXPECT_TRUE(std::holds_alternative<PayloadRef>(second));
  EXPECT_EQ(bench.metrics.value(Count::kChunkHit), 1U);
}

TEST(ChunkService, TakesAJobBackWhenItsLastAskerLosesInterest) {
  Bench bench;
  const auto busy = bench.service.request(name_of(0), kHttp, [](const ChunkResult&) {});
  bench.builder.wait_for_start();
  {
    const auto a = bench.service.request(name_of(1), kStream, [](const ChunkResult&) {});
    {
      const auto b = bench.service.request(name_of(1), kStream, [](const ChunkResult&) {});
    }
    EXPECT_EQ(bench.pool.queued(Lane::kView), 1U) << "one still wants it";
  }
  EXPECT_EQ(bench.pool.queued(Lane::kView), 0U);
  EXPECT_EQ(bench.metrics.value(Count::kChunkCancelled), 1U);
}

TEST(ChunkService, TellsARunningJobToStopWhenNobodyWantsIt) {
  Bench bench;
  {
    const auto answer = bench.service.request(name_of(1), kStream, [](const ChunkResult&) {});
    bench.builder.wait_for_start();
  }
  while (bench.builder.cancelled == 0) {
    bench.builder.wake();
    std::this_thread::yield();
  }
  EXPECT_EQ(bench.builder.built, 0);
  EXPECT_EQ(bench.service.flights(), 0U);
}

TEST(ChunkService, StartsAnewWhenAChunkIsWantedAgainWhileItsOldJobIsStopping) {
  Bench bench;
  {
    const auto given_up = bench.service.request(name_of(1), kStream, [](const ChunkResult&) {});
    bench.builder.wait_for_start();
  }
  std::promise<bool> done;
  const auto again =
      bench.service.request(name_of(1), kStream, [&](const ChunkResult& r) { done.set_value(r.has_value()); });
  ASSERT_TRUE(std::holds_alternative<Ticket>(again));
  bench.builder.open();
  EXPECT_TRUE(done.get_future().get());
}

TEST(ChunkService, RefusesColdChunksWhenTheLaneIsFull) {
  Bench bench(2);
  const auto running = bench.service.request(name_of(0), kHttp, [](const ChunkResult&) {});
  bench.builder.wait_for_start();
  const auto a = bench.service.request(name_of(1), kHttp, [](const ChunkResult&) {});
  const auto b = bench.service.request(name_of(2), kHttp, [](const ChunkResult&) {});
  const auto c = bench.service.request(name_of(3), kHttp, [](const ChunkResult&) {});
  ASSERT_TRUE(std::holds_alternative<ChunkError>(c));
  EXPECT_EQ(std::get<ChunkError>(c), ChunkError::kBusy);
  const auto joins = bench.service.request(name_of(1), kHttp, [](const ChunkResult&) {});
  EXPECT_TRUE(std::holds_alternative<Ticket>(joins)) << "a chunk that is queued already costs no place";
}

TEST(ChunkService, AnswersWithAnErrorWhenTheJobThrowsAndGoesOn) {
  set_log_level(LogLevel::kOff);
  Bench bench;
  bench.builder.open();
  std::promise<ChunkResult> failed;
  const auto bad = bench.service.request(name_of(1, 12), kHttp, [&](ChunkResult r) { failed.set_value(r); });
  const ChunkResult result = failed.get_future().get();
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error(), ChunkError::kFailed);
  std::promise<bool> done;
  const auto good =
      bench.service.request(name_of(2), kHttp, [&](const ChunkResult& r) { done.set_value(r.has_value()); });
  EXPECT_TRUE(done.get_future().get());
}

TEST(ChunkService, IsAsUrgentAsItsMostUrgentAsker) {
  Bench bench;
  const auto busy = bench.service.request(name_of(0), kStream, [](const ChunkResult&) {});
  bench.builder.wait_for_start();
  std::mutex mutex;
  std::vector<int> order;
  std::promise<void> both;
  const auto done = [&](int which) {
    return [&, which](const ChunkResult&) {
      const std::lock_guard lock(mutex);
      order.push_back(which);
      if (order.size() == 3) both.set_value();
    };
  };
  auto far = bench.service.request(name_of(1), {2, Lane::kView, 50.0}, done(1));
  auto near = bench.service.request(name_of(2), {2, Lane::kView, 10.0}, done(2));
  auto joined = bench.service.request(name_of(1), {2, Lane::kView, 90.0}, done(1));
  std::get<Ticket>(joined).set_urgency(Lane::kView, 1.0);
  bench.builder.open();
  both.get_future().wait();
  EXPECT_EQ(order, (std::vector<int>{1, 1, 2}));
}

/// A bench whose pool gives up what does not end.
struct ImpatientBench {
  ~ImpatientBench() {
    builder.open();
    while (pool.hanging() != 0) std::this_thread::yield();
  }
  SystemClock clock;
  Metrics metrics;
  MemoryCache cache{1 << 20};
  Worlds worlds;
  StoredChunks stored{worlds};
  StubbornBuilder builder;
  JobPool pool{{.threads = 1, .job_s = 0.2, .spares = 2}};
  ChunkService service{cache, stored, pool, builder, clock, metrics};
};

TEST(ChunkService, AnswersFailedForAChunkThatHangsAndServesTheOthers) {
  set_log_level(LogLevel::kOff);
  ImpatientBench bench;
  std::promise<ChunkResult> hung;
  const auto ticket = bench.service.request(kStubborn, kHttp, [&](ChunkResult r) { hung.set_value(std::move(r)); });
  ASSERT_TRUE(std::holds_alternative<ChunkService::Ticket>(ticket));
  EXPECT_EQ(hung.get_future().get().error(), ChunkError::kFailed);
  EXPECT_EQ(bench.metrics.value(Count::kChunkHung), 1U);

  const auto again = bench.service.request(kStubborn, kStream, [](const ChunkResult&) { ADD_FAILURE(); });
  ASSERT_TRUE(std::holds_alternative<ChunkError>(again)) << "another thread is not risked";
  EXPECT_EQ(std::get<ChunkError>(again), ChunkError::kFailed);

  std::promise<ChunkResult> made;
  const auto waits = bench.service.request(name_of(7), kHttp, [&](ChunkResult r) { made.set_value(std::move(r)); });
  EXPECT_TRUE(made.get_future().get().has_value());

  // It ends after all: what it has made is good, and it may be asked for again.
  bench.builder.open();
  while (bench.pool.hanging() != 0) std::this_thread::yield();
  EXPECT_TRUE(std::holds_alternative<PayloadRef>(bench.service.request(kStubborn, kHttp, [](const ChunkResult&) {})));
  set_log_level(LogLevel::kInfo);
}

}  // namespace
}  // namespace talus::server
