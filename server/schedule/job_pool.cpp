#include "server/schedule/job_pool.hpp"

#include <algorithm>
#include <utility>

#include "core/base/check.hpp"

namespace talus::server {

namespace {

/// What one overtaking is worth. Urgencies are distances in chunk edges, 0 to about 100: a job at the far end comes
/// first after 100 / 0.25 = 400 overtakings.
constexpr double kUrgencyPerOvertaking = 0.25;

}  // namespace

JobPool::JobPool(JobPoolOptions options) : options_(options) {
  TALUS_CHECK(options_.threads > 0);
  threads_.reserve(options_.threads);
  for (std::size_t i = 0; i < options_.threads; ++i) {
    threads_.emplace_back([this, i] { run(i); });
  }
}

JobPool::~JobPool() {
  stop();
}

JobPool::JobRef JobPool::push(Lane lane, double urgency, Work work) {
  auto job = std::make_shared<Job>();
  job->urgency.store(urgency, std::memory_order_relaxed);
  job->lane = lane;
  job->work = std::move(work);
  {
    const std::lock_guard lock(mutex_);
    auto& list = queued_[static_cast<std::size_t>(lane)];
    if (stopped_ || list.size() >= options_.queued_per_lane) return nullptr;
    job->popped_at_push = popped_[static_cast<std::size_t>(lane)];
    list.push_back(job);
  }
  wake_.notify_one();
  return job;
}

bool JobPool::cancel(const JobRef& job) {
  job->token.cancel();
  Work dropped;  // destroyed outside the lock: it may own anything
  const std::lock_guard lock(mutex_);
  auto& list = queued_[static_cast<std::size_t>(job->lane)];
  const auto found = std::find(list.begin(), list.end(), job);
  if (found == list.end()) return false;
  dropped = std::move(job->work);
  list.erase(found);
  return true;
}

void JobPool::stop() {
  std::array<std::vector<JobRef>, kLanes> dropped;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped.swap(queued_);
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

std::size_t JobPool::queued(Lane lane) const {
  const std::lock_guard lock(mutex_);
  return queued_[static_cast<std::size_t>(lane)].size();
}

JobPool::JobRef JobPool::pop_most_urgent() {
  turn_ = (turn_ + 1) % kLanes;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::size_t lane = (turn_ + i) % kLanes;
    auto& list = queued_[lane];
    if (list.empty()) continue;
    const auto value = [&](const JobRef& job) {
      const auto overtaken = static_cast<double>(popped_[lane] - job->popped_at_push);
      return job->urgency.load(std::memory_order_relaxed) - kUrgencyPerOvertaking * overtaken;
    };
    auto best = list.begin();
    double best_value = value(*best);
    for (auto it = list.begin() + 1; it != list.end(); ++it) {
      if (const double v = value(*it); v < best_value) {
        best = it;
        best_value = v;
      }
    }
    JobRef job = std::move(*best);
    list.erase(best);  // keeps the order of arrival, which decides between equals
    ++popped_[lane];
    return job;
  }
  return nullptr;
}

void JobPool::run(std::size_t thread) {
  for (;;) {
    JobRef job;
    Work work;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] {
        return stopped_ || std::any_of(queued_.begin(), queued_.end(), [](const auto& l) { return !l.empty(); });
      });
      if (stopped_) return;
      job = pop_most_urgent();
      work = std::move(job->work);
    }
    try {
      work(Context{thread, job->token});
    } catch (...) {
      failed_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace talus::server
