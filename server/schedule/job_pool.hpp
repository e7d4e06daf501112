// A fixed set of threads that evaluate terrain, most urgent job first.
//
// Urgency moves with the viewers, so an order fixed when a job came in would soon be wrong: jobs wait in a plain list,
// and a free thread takes the one that is most urgent at that moment. Lists are short by limit (256 a lane: one scan is
// below a microsecond, a job about a millisecond), so nothing is kept sorted. Jobs that are overtaken grow more urgent,
// so none starves. Two lanes take turns, so that neither door can shut the other out.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/schedule/cancel_token.hpp"

namespace talus::server {

enum class Lane : std::uint8_t { kStream, kHttp };
inline constexpr std::size_t kLanes = 2;

struct JobPoolOptions {
  std::size_t threads = 1;
  std::size_t queued_per_lane = 256;
};

class JobPool {
 public:
  /// What a job is told: its thread's index below `threads`, for memory kept per thread, and its token.
  struct Context {
    std::size_t thread = 0;
    const CancelToken& token;
  };
  using Work = std::move_only_function<void(const Context&)>;

  /// A queued or running job. Shared by its owner and the pool.
  struct Job {
    std::atomic<double> urgency{0.0};  ///< smaller is sooner; any thread may move it
    CancelToken token;

   private:
    friend class JobPool;
    Lane lane = Lane::kStream;
    std::uint64_t popped_at_push = 0;
    Work work;
  };
  using JobRef = std::shared_ptr<Job>;

  explicit JobPool(JobPoolOptions options);
  /// Stops, drops what is queued, waits for what runs.
  ~JobPool();
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  /// Null when the lane is full or the pool has stopped: shed and come again.
  JobRef push(Lane lane, double urgency, Work work);
  /// Sets the token. True when the job had not started: it never will, and its work is destroyed.
  bool cancel(const JobRef& job);
  /// Refuses new jobs, destroys the queued, waits for the running. Idempotent; not from a job.
  void stop();

  std::size_t threads() const { return options_.threads; }
  std::size_t queued(Lane lane) const;
  /// Jobs that let an exception escape. It ends the job, never the thread.
  std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  void run(std::size_t thread);
  JobRef pop_most_urgent();

  const JobPoolOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::array<std::vector<JobRef>, kLanes> queued_;
  std::array<std::uint64_t, kLanes> popped_{};
  std::size_t turn_ = 0;
  bool stopped_ = false;
  std::atomic<std::uint64_t> failed_{0};
  std::vector<std::thread> threads_;
};

}  // namespace talus::server
