#include "server/schedule/job_pool.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/check.hpp"

namespace talus::server {

namespace {

/// A job's age is counted in rounds of the watch, so many to `job_s`: a machine that slept has made nobody older.
constexpr int kRounds = 8;
/// How long `stop` waits for jobs that have been told to end.
constexpr double kStopS = 2;

}  // namespace

JobPool::JobPool(JobPoolOptions options)
    : options_(options),
      queue_(options.queued_per_lane, options.queued_per_client),
      seats_(options.threads + options.spares) {
  TALUS_CHECK(options_.threads > 0);
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < options_.threads; ++i) seat_thread(i);
  if (options_.job_s > 0) watch_ = std::thread([this] { watch(); });
}

JobPool::~JobPool() {
  stop();
  TALUS_CHECK(hanging() == 0);
}

JobPool::Pushed JobPool::push(const JobTerms& terms, Work work, OnHang on_hang) {
  auto job = std::make_shared<Job>();
  job->urgency.store(terms.urgency, std::memory_order_relaxed);
  job->cost_s = terms.cost_s;
  job->work = std::move(work);
  job->on_hang = std::move(on_hang);
  Pushed pushed;
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return pushed;
    FairQueue::Pushed queued = queue_.push(job, terms.client, terms.lane);
    pushed.is_over_share = queued.is_over_share;
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
    for (Seat& seat : seats_) {
      seat.age = 0;
      if (seat.job != nullptr && options_.job_s > 0) seat.job->token.cancel();
    }
  }
  wake_.notify_all();
  watch_wake_.notify_all();
  if (watch_.joinable()) watch_.join();  // it leaves when every job has ended or was given up
  for (Seat& seat : seats_) {
    if (!seat.thread.joinable()) continue;
    bool is_hanging = false;
    {
      const std::lock_guard lock(mutex_);
      is_hanging = seat.is_given_up && !seat.is_over;
    }
    is_hanging ? seat.thread.detach() : seat.thread.join();
  }
}

std::size_t JobPool::queued(Lane lane) const {
  const std::lock_guard lock(mutex_);
  return queue_.size(lane);
}

double JobPool::wait_s() const {
  const std::lock_guard lock(mutex_);
  return queue_.cost_s() / static_cast<double>(std::max<std::size_t>(1, working()));
}

std::size_t JobPool::threads() const {
  const std::lock_guard lock(mutex_);
  return working();
}

std::size_t JobPool::hanging() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::ranges::count_if(seats_, [](const Seat& seat) { return seat.is_given_up && !seat.is_over; }));
}

void JobPool::run(std::size_t index) {
  // On Linux "this process" is the calling thread. Making oneself humbler is always allowed, and no more than a wish.
  if (options_.nice > 0) setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + options_.nice);
  JobRef job;
  Work work;
  while (take(index, job, work)) {
    try {
      work(Context{index, job->token, job->client(), job->cost_s});
    } catch (...) {
      failed_.fetch_add(1, std::memory_order_relaxed);
    }
    work = {};
  }
}

/// Ends the seat's last job and waits for its next. False when the thread has to leave.
bool JobPool::take(std::size_t index, JobRef& job, Work& work) {
  const JobRef ended = std::move(job);  // destroyed outside the lock: it may own anything
  std::unique_lock lock(mutex_);
  Seat& seat = seats_[index];
  seat.job = nullptr;
  if (!seat.is_given_up) wake_.wait(lock, [&] { return stopped_ || !queue_.empty(); });
  if (seat.is_given_up || stopped_) {
    seat.is_over = true;
    watch_wake_.notify_all();
    return false;
  }
  job = std::static_pointer_cast<Job>(queue_.pop());
  work = std::move(job->work);
  seat.job = job;
  seat.age = 0;
  return true;
}

/// Under mutex_.
bool JobPool::has_running() const {
  return std::ranges::any_of(seats_, [](const Seat& seat) { return seat.job != nullptr && !seat.is_given_up; });
}

void JobPool::watch() {
  std::unique_lock lock(mutex_);
  while (!stopped_ || has_running()) {
    const double patience_s = stopped_ ? std::min(options_.job_s, kStopS) : options_.job_s;
    const std::chrono::duration<double> round(patience_s / kRounds);
    const bool was_stopped = stopped_;
    if (watch_wake_.wait_for(lock, round, [&] { return stopped_ != was_stopped || (stopped_ && !has_running()); })) {
      continue;
    }
    const std::vector<JobRef> hung = give_up_old_jobs();
    if (!stopped_) refill_seats();
    if (hung.empty()) continue;
    lock.unlock();
    for (const JobRef& job : hung) {
      job->token.cancel();
      if (job->on_hang) job->on_hang();
    }
    lock.lock();
  }
}

/// Under mutex_: everything that runs is a round older.
std::vector<JobPool::JobRef> JobPool::give_up_old_jobs() {
  std::vector<JobRef> out;
  for (Seat& seat : seats_) {
    if (seat.job == nullptr || seat.is_given_up || ++seat.age <= kRounds) continue;
    seat.is_given_up = true;
    hung_.fetch_add(1, std::memory_order_relaxed);
    out.push_back(seat.job);
  }
  return out;
}

/// Under mutex_.
std::size_t JobPool::working() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      seats_, [](const Seat& seat) { return seat.thread.joinable() && !seat.is_given_up && !seat.is_over; }));
}

/// Under mutex_. New threads in the places of hung ones, on seats that nobody has had or whose hung job has come back.
void JobPool::refill_seats() {
  std::size_t missing = options_.threads - working();
  for (std::size_t i = 0; i < seats_.size() && missing > 0; ++i) {
    Seat& seat = seats_[i];
    if (seat.thread.joinable() && !seat.is_over) continue;
    if (seat.thread.joinable()) seat.thread.join();  // it has let go of the mutex for the last time
    seat_thread(i);
    --missing;
  }
}

/// Under mutex_.
void JobPool::seat_thread(std::size_t index) {
  seats_[index] = Seat{};
  seats_[index].thread = std::thread([this, index] { run(index); });
}

}  // namespace talus::server
