#include "server/schedule/job_pool.hpp"

#include <utility>

#include "core/base/check.hpp"

namespace talus::server {

JobPool::JobPool(JobPoolOptions options) : options_(options), queue_(options.queued_per_lane) {
  TALUS_CHECK(options_.threads > 0);
  threads_.reserve(options_.threads);
  for (std::size_t i = 0; i < options_.threads; ++i) {
    threads_.emplace_back([this, i] { run(i); });
  }
}

JobPool::~JobPool() {
  stop();
}

JobPool::Pushed JobPool::push(const JobTerms& terms, Work work) {
  auto job = std::make_shared<Job>();
  job->urgency.store(terms.urgency, std::memory_order_relaxed);
  job->cost_s = terms.cost_s;
  job->work = std::move(work);
  Pushed pushed;
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return pushed;
    FairQueue::Pushed queued = queue_.push(job, terms.client, terms.lane);
    if (!queued.is_queued) return pushed;
    pushed.displaced = std::static_pointer_cast<Job>(std::move(queued.displaced));
  }
  wake_.notify_one();
  pushed.job = std::move(job);
  return pushed;
}

void JobPool::tell_displaced(const JobRef& job) {
  if (job == nullptr) return;
  Work work = std::move(job->work);
  job->token.cancel();
  work(Context{0, job->token, 0, job->cost_s, true});
}

void JobPool::claim(const JobRef& job, ClientId client) {
  const std::lock_guard lock(mutex_);
  queue_.claim(job, client);
}

void JobPool::unclaim(const JobRef& job, ClientId client) {
  const std::lock_guard lock(mutex_);
  queue_.unclaim(job, client);
}

void JobPool::move(const JobRef& job, Lane lane) {
  const std::lock_guard lock(mutex_);
  queue_.move(job, lane);
}

bool JobPool::cancel(const JobRef& job) {
  job->token.cancel();
  Work dropped;  // destroyed outside the lock: it may own anything
  const std::lock_guard lock(mutex_);
  if (!queue_.remove(job)) return false;
  dropped = std::move(job->work);
  return true;
}

void JobPool::charge(ClientId client, double cost_s) {
  const std::lock_guard lock(mutex_);
  queue_.charge(client, cost_s);
}

void JobPool::stop() {
  std::vector<FairQueue::ItemRef> dropped;  // destroyed outside the lock
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped = queue_.clear();
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

std::size_t JobPool::queued(Lane lane) const {
  const std::lock_guard lock(mutex_);
  return queue_.size(lane);
}

double JobPool::wait_s() const {
  const std::lock_guard lock(mutex_);
  return queue_.cost_s() / static_cast<double>(options_.threads);
}

void JobPool::run(std::size_t thread) {
  for (;;) {
    JobRef job;
    Work work;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stopped_ || !queue_.empty(); });
      if (stopped_) return;
      job = std::static_pointer_cast<Job>(queue_.pop());
      work = std::move(job->work);
    }
    try {
      work(Context{thread, job->token, job->client(), job->cost_s});
    } catch (...) {
      failed_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace talus::server
