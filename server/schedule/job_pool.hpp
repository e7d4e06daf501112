// A fixed set of threads that evaluate terrain; which job is next is FairQueue's to say, at the moment a thread is
// free.
//
// A job that does not end must not cost the pool a thread: one that has run for `job_s` is given up. Its askers are
// told, and a new thread takes the place of its own, which ends when the job does, if ever. Threads cannot be ended
// from outside, so there are only so many new ones; after them a hung job does cost its thread.
//
// Jobs wait in short lists by limit (256 a lane: one look at all of them takes microseconds, a job about a
// millisecond), so nothing is kept sorted, and an urgency that moves with its viewer is never stale.
#pragma once

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
#include "server/schedule/fair_queue.hpp"

namespace talus::server {

struct JobPoolOptions {
  std::size_t threads = 1;
  std::size_t queued_per_lane = 256;
  std::size_t queued_per_client = 256;
  double job_s = 0;        ///< a job that runs longer is given up; 0: none is
  std::size_t spares = 0;  ///< threads that may take the place of hung ones
  int nice = 0;            ///< of its threads, 0..19, added to the process's: whoever else wants a processor goes first
};

/// Who wants a job, how soon, and what it is expected to cost.
struct JobTerms {
  ClientId client = 0;
  Lane lane = Lane::kView;
  double urgency = 0.0;
  double cost_s = 0.001;
};

class JobPool {
 public:
  /// What a job is told.
  struct Context {
    std::size_t thread = 0;  ///< index below `thread_indices`, for memory kept per thread
    const CancelToken& token;
    ClientId client = 0;        ///< whose turn it was
    double cost_s = 0;          ///< what its terms said
    bool is_displaced = false;  ///< it had to make room for another client's and must only say so; `thread` is nobody's
  };
  using Work = std::move_only_function<void(const Context&)>;
  /// Told once, on a thread of the pool's own, that the job was given up while its work was still running.
  using OnHang = std::move_only_function<void()>;

  /// A queued or running job. Shared by its owner and the pool.
  struct Job : FairQueue::Item {
    CancelToken token;

   private:
    friend class JobPool;
    Work work;
    OnHang on_hang;
  };
  using JobRef = std::shared_ptr<Job>;

  struct Pushed {
    JobRef job;                  ///< null when the lane is full or the pool has stopped: shed and come again
    bool is_over_share = false;  ///< null for this reason: the client has too much waiting
    JobRef displaced;            ///< to be given to `tell_displaced` once the caller holds no lock
  };

  explicit JobPool(JobPoolOptions options);
  /// Stops. Requires that no job hangs any more (`hanging`): it would come back to a pool that is gone.
  ~JobPool();
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  Pushed push(const JobTerms& terms, Work work, OnHang on_hang = {});
  /// Runs the work of a displaced job, here, so that it tells whoever waits.
  static void tell_displaced(const JobRef& job);
  /// Another client wants a job as well, or no more; at least one must be left. Nothing once it has started.
  void claim(const JobRef& job, ClientId client);
  void unclaim(const JobRef& job, ClientId client);
  /// A job that waits goes on waiting in another lane.
  void move(const JobRef& job, Lane lane);
  /// Sets the token. True when the job had not started: it never will, and its work is destroyed.
  bool cancel(const JobRef& job);
  /// A job of this client took so much longer, or shorter, than its terms said.
  void charge(ClientId client, double cost_s);
  /// Refuses new jobs, destroys the queued, tells the running to stop and waits for them; with `job_s`, at most 2 s.
  /// Idempotent; not from a job.
  void stop();

  /// Threads that work or wait for work: as many as were asked for, but for those that hung jobs have cost.
  std::size_t threads() const;
  /// Bound of Context::thread.
  std::size_t thread_indices() const { return options_.threads + options_.spares; }
  /// Jobs given up so far.
  std::uint64_t hung() const { return hung_.load(std::memory_order_relaxed); }
  /// Of those, the ones whose work has not come back yet.
  std::size_t hanging() const;
  std::size_t queued(Lane lane) const;
  /// When the last of what is queued is expected to start, from now.
  double wait_s() const;
  /// Jobs that let an exception escape. It ends the job, never the thread.
  std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  /// One thread and what it runs.
  struct Seat {
    std::thread thread;
    JobRef job;                ///< null: it waits for one
    int age = 0;               ///< of the job, in rounds of the watch
    bool is_given_up = false;  ///< the job hangs
    bool is_over = false;      ///< the thread has left for good
  };

  void run(std::size_t index);
  bool take(std::size_t index, JobRef& job, Work& work);
  void watch();
  std::vector<JobRef> give_up_old_jobs();
  void seat_thread(std::size_t index);
  void refill_seats();
  std::size_t working() const;
  bool has_running() const;

  const JobPoolOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable watch_wake_;
  FairQueue queue_;
  bool stopped_ = false;
  std::atomic<std::uint64_t> failed_{0};
  std::atomic<std::uint64_t> hung_{0};
  std::vector<Seat> seats_;  ///< by Context::thread
  std::thread watch_;
};

}  // namespace talus::server
