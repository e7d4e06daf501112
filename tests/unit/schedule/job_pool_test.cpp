#include "server/schedule/job_pool.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace talus::server {
namespace {

JobTerms terms(Lane lane, double urgency, ClientId client = 1) {
  return {client, lane, urgency, 0.001};
}

/// A pool of one thread that is kept busy until `open` is called, so that what follows is queued.
class HeldPool {
 public:
  explicit HeldPool(std::size_t queued_per_lane = 256) : pool({1, queued_per_lane}) {
    std::promise<void> started;
    pool.push(terms(Lane::kView, 0.0), [this, &started](const JobPool::Context&) {
      started.set_value();
      opened_.get_future().wait();
    });
    started.get_future().wait();
  }
  void open() { opened_.set_value(); }

 private:
  std::promise<void> opened_;

 public:
  JobPool pool;
};

/// Waits until everything pushed to one lane before has run.
void finish(JobPool& pool) {
  std::promise<void> done;
  pool.push(terms(Lane::kView, 1e9), [&](const JobPool::Context&) { done.set_value(); });
  done.get_future().wait();
}

TEST(JobPool, RunsTheMostUrgentJobFirst) {
  HeldPool held;
  std::string order;
  const auto append = [&](char c) { return [&order, c](const JobPool::Context&) { order += c; }; };
  held.pool.push(terms(Lane::kView, 30.0), append('c'));
  held.pool.push(terms(Lane::kView, 10.0), append('a'));
  held.pool.push(terms(Lane::kView, 20.0), append('b'));
  held.open();
  finish(held.pool);
  EXPECT_EQ(order, "abc");
}

TEST(JobPool, LooksAtUrgencyWhenAThreadIsFreeNotWhenTheJobCameIn) {
  HeldPool held;
  std::string order;
  const auto append = [&](char c) { return [&order, c](const JobPool::Context&) { order += c; }; };
  const auto first = held.pool.push(terms(Lane::kView, 1.0), append('a'));
  held.pool.push(terms(Lane::kView, 2.0), append('b'));
  first.job->urgency.store(50.0);
  held.open();
  finish(held.pool);
  EXPECT_EQ(order, "ba");
}

TEST(JobPool, RunsEqualJobsInOrderOfArrival) {
  HeldPool held;
  std::string order;
  for (const char c : std::string("abcdef")) {
    held.pool.push(terms(Lane::kView, 1.0), [&order, c](const JobPool::Context&) { order += c; });
  }
  held.open();
  finish(held.pool);
  EXPECT_EQ(order, "abcdef");
}

TEST(JobPool, LetsNoJobStarveBehindMoreUrgentOnesThatKeepComing) {
  HeldPool held;
  bool has_run = false;
  held.pool.push(terms(Lane::kView, 20.0), [&](const JobPool::Context&) { has_run = true; });
  // Each pushes a successor that is more urgent than the waiting job: without ageing it would wait for all of them.
  int left = 1000;
  std::promise<int> seen;
  std::function<void(const JobPool::Context&)> next = [&](const JobPool::Context&) {
    if (has_run || --left == 0) return seen.set_value(left);
    held.pool.push(terms(Lane::kView, 0.0), next);
  };
  held.pool.push(terms(Lane::kView, 0.0), next);
  held.open();
  EXPECT_GT(seen.get_future().get(), 800);
}

TEST(JobPool, TellsADisplacedJobWhenItsPusherIsReady) {
  HeldPool held(2);
  int displaced = 0;
  const auto count = [&](const JobPool::Context& context) { displaced += context.is_displaced ? 1 : 0; };
  const auto greedy_1 = held.pool.push(terms(Lane::kView, 0.0, 7), count);
  const auto greedy_2 = held.pool.push(terms(Lane::kView, 1.0, 7), count);
  const auto modest = held.pool.push(terms(Lane::kView, 9.0, 8), count);
  ASSERT_NE(modest.job, nullptr);
  ASSERT_EQ(modest.displaced, greedy_2.job);
  EXPECT_EQ(displaced, 0);
  JobPool::tell_displaced(modest.displaced);
  EXPECT_EQ(displaced, 1);
  EXPECT_FALSE(held.pool.cancel(greedy_2.job)) << "it is not queued any more";
  held.open();
}

TEST(JobPool, ForeseesWhenItsQueueIsDone) {
  HeldPool held;
  const auto nothing = [](const JobPool::Context&) {};
  for (int i = 0; i < 20; ++i) held.pool.push({1, Lane::kView, 0.0, 0.1}, nothing);
  EXPECT_NEAR(held.pool.wait_s(), 2.0, 1e-9);
  held.open();
}

TEST(JobPool, RefusesWhenALaneIsFullButKeepsTheOtherOpen) {
  HeldPool held(2);
  const auto nothing = [](const JobPool::Context&) {};
  EXPECT_NE(held.pool.push(terms(Lane::kView, 0.0), nothing).job, nullptr);
  EXPECT_NE(held.pool.push(terms(Lane::kView, 0.0), nothing).job, nullptr);
  EXPECT_EQ(held.pool.push(terms(Lane::kView, 0.0), nothing).job, nullptr);
  EXPECT_EQ(held.pool.queued(Lane::kView), 2U);
  EXPECT_NE(held.pool.push(terms(Lane::kCover, 0.0), nothing).job, nullptr);
  held.open();
}

TEST(JobPool, NeverStartsACancelledJobAndFreesItsPlace) {
  HeldPool held(1);
  bool has_run = false;
  const auto pushed = held.pool.push(terms(Lane::kView, 0.0), [&](const JobPool::Context&) { has_run = true; });
  EXPECT_TRUE(held.pool.cancel(pushed.job));
  EXPECT_EQ(held.pool.queued(Lane::kView), 0U);
  held.open();
  finish(held.pool);
  EXPECT_FALSE(has_run);
}

TEST(JobPool, TellsARunningJobThatItIsCancelled) {
  JobPool pool({1, 8});
  std::promise<void> started;
  std::promise<void> cancelled;
  std::promise<bool> seen;
  const auto pushed = pool.push(terms(Lane::kView, 0.0), [&](const JobPool::Context& context) {
    started.set_value();
    cancelled.get_future().wait();
    seen.set_value(context.token.is_cancelled());
  });
  started.get_future().wait();
  EXPECT_FALSE(pool.cancel(pushed.job));
  cancelled.set_value();
  EXPECT_TRUE(seen.get_future().get());
}

TEST(JobPool, OutlivesAJobThatThrows) {
  JobPool pool({1, 8});
  pool.push(terms(Lane::kView, 0.0), [](const JobPool::Context&) { throw std::runtime_error("broken"); });
  finish(pool);
  EXPECT_EQ(pool.failed(), 1U);
}

TEST(JobPool, GivesEveryThreadAnIndexOfItsOwn) {
  JobPool pool({3, 64});
  std::array<std::atomic<int>, 3> inside{};
  std::atomic<int> left{60};
  std::atomic<bool> is_shared{false};
  std::promise<void> done;
  for (int i = 0; i < 60; ++i) {
    pool.push(terms(Lane::kView, 0.0), [&](const JobPool::Context& context) {
      if (inside.at(context.thread).fetch_add(1) != 0) is_shared = true;
      inside.at(context.thread).fetch_sub(1);
      if (left.fetch_sub(1) == 1) done.set_value();
    });
  }
  done.get_future().wait();
  EXPECT_FALSE(is_shared);
}

TEST(JobPool, DropsWhatIsQueuedWhenItStops) {
  HeldPool held;
  const auto owned = std::make_shared<int>(1);
  held.pool.push(terms(Lane::kView, 0.0), [owned](const JobPool::Context&) {});
  held.open();
  held.pool.stop();
  EXPECT_EQ(owned.use_count(), 1);
  EXPECT_EQ(held.pool.push(terms(Lane::kView, 0.0), [](const JobPool::Context&) {}).job, nullptr);
}

/// Hangs every job that asks it to, until it is let go.
struct Trap {
  void hang() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return is_open; });
  }
  void open() {
    const std::lock_guard lock(mutex);
    is_open = true;
    changed.notify_all();
  }
  std::mutex mutex;
  std::condition_variable changed;
  bool is_open = false;
};

TEST(JobPool, RunsItsJobsAsHumblyAsItWasTold) {
  const int ours = getpriority(PRIO_PROCESS, 0);
  if (ours > 16) GTEST_SKIP() << "this process is as humble as can be";
  for (const int nice : {0, 3}) {
    JobPool pool({.threads = 1, .nice = nice});
    std::promise<int> theirs;
    pool.push(terms(Lane::kView, 0.0),
              [&](const JobPool::Context&) { theirs.set_value(getpriority(PRIO_PROCESS, 0)); });
    EXPECT_EQ(theirs.get_future().get(), ours + nice);
  }
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), ours);
}

TEST(JobPool, GivesUpAJobThatHangsAndServesOnWithANewThread) {
  Trap trap;
  JobPool pool({.threads = 1, .job_s = 0.2, .spares = 1});
  std::promise<void> told;
  std::atomic<bool> was_cancelled = false;
  pool.push(
      terms(Lane::kView, 0.0),
      [&](const JobPool::Context& context) {
        trap.hang();
        was_cancelled = context.token.is_cancelled();
      },
      [&] { told.set_value(); });
  told.get_future().wait();
  EXPECT_EQ(pool.hung(), 1U);
  EXPECT_EQ(pool.hanging(), 1U);
  finish(pool);
  EXPECT_EQ(pool.threads(), 1U);
  trap.open();
  while (pool.hanging() != 0) std::this_thread::yield();
  EXPECT_TRUE(was_cancelled);
}

TEST(JobPool, HasOnlySoManyThreadsForHungJobsUntilTheyComeBack) {
  Trap trap;
  JobPool pool({.threads = 1, .job_s = 0.1, .spares = 1});
  std::promise<void> told;
  std::atomic<int> hung = 0;
  for (int i = 0; i < 2; ++i) {
    pool.push(
        terms(Lane::kView, i),
        [&](const JobPool::Context& context) {
          EXPECT_LT(context.thread, pool.thread_indices());
          trap.hang();
        },
        [&] {
          if (++hung == 2) told.set_value();
        });
  }
  told.get_future().wait();
  EXPECT_EQ(pool.threads(), 0U) << "the second has cost its thread";
  std::promise<void> done;
  pool.push(terms(Lane::kView, 9.0), [&](const JobPool::Context&) { done.set_value(); });
  trap.open();
  while (pool.hanging() != 0) std::this_thread::yield();
  done.get_future().wait();
  EXPECT_EQ(pool.threads(), 1U) << "who comes back makes room for a new one";
}

TEST(JobPool, StopsThoughAJobHangs) {
  Trap trap;
  auto pool = std::make_unique<JobPool>(JobPoolOptions{.threads = 2, .job_s = 0.1});
  std::promise<void> started;
  pool->push(terms(Lane::kView, 0.0), [&](const JobPool::Context&) { started.set_value(), trap.hang(); });
  started.get_future().wait();
  pool->stop();
  EXPECT_EQ(pool->hanging(), 1U);
  trap.open();
  while (pool->hanging() != 0) std::this_thread::yield();
}

}  // namespace
}  // namespace talus::server
