// Chunks for every door, one way: from memory, from the job somebody else has started, or from a job of one's own,
// which reads the disk before it builds.
//
// Single flight: however many ask for an absent chunk, one job makes it. Every asker holds a ticket; when the last one
// drops its ticket nobody wants the chunk, and the job is taken back or, if it runs, told to stop. A job is served when
// the turn of any of its askers comes (schedule/fair_queue). A chunk whose job hangs is refused for as long as it does,
// so that asking again costs no other thread. Any thread.
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <mutex>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "server/cache/memory_cache.hpp"
#include "server/observe/metrics.hpp"
#include "server/schedule/clock.hpp"
#include "server/schedule/job_pool.hpp"
#include "server/world/chunk_builder.hpp"
#include "server/world/stored_chunks.hpp"

namespace talus::server {

enum class ChunkError : std::uint8_t {
  kBusy,   ///< the lane is full, or others were due more than this asker: come again
  kFailed  ///< the chunk could not be made, or hangs whoever makes it
};

/// Who wants a chunk, and how soon.
struct Asker {
  ClientId client = 0;
  Lane lane = Lane::kView;
  double urgency = 0.0;  ///< smaller is sooner, within the lane
};

using ChunkResult = std::expected<PayloadRef, ChunkError>;

class ChunkService {
 public:
  /// Called once, on any thread; must be quick and must not throw: post and return. May still be called after its
  /// ticket is gone, if the answer was under way.
  using Done = std::move_only_function<void(ChunkResult)>;

  /// One asker's interest in a chunk that is being made. Dropping it withdraws. Must not outlive the service.
  class Ticket {
   public:
    Ticket() = default;
    Ticket(Ticket&& other) noexcept;
    Ticket& operator=(Ticket&& other) noexcept;
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;
    ~Ticket() { drop(); }

    /// A job is in the lane of its foremost asker and as urgent as its most urgent.
    void set_urgency(Lane lane, double urgency);
    void drop();

   private:
    friend class ChunkService;
    Ticket(ChunkService* service, const PayloadName& name, std::uint64_t id)
        : service_(service), name_(name), id_(id) {}

    ChunkService* service_ = nullptr;
    PayloadName name_;
    std::uint64_t id_ = 0;
  };

  /// The payload itself, a ticket for it, or why there is neither. `done` is called only for a ticket.
  using Answer = std::variant<PayloadRef, Ticket, ChunkError>;

  /// All must outlive the service; the pool must be stopped before the service ends.
  ChunkService(MemoryCache& cache, StoredChunks& stored, JobPool& pool, ChunkBuilder& builder, const Clock& clock,
               Metrics& metrics);
  ChunkService(const ChunkService&) = delete;
  ChunkService& operator=(const ChunkService&) = delete;

  /// What is in memory or can be known without work; else nullptr, and `make` is the next step. Cheap. Requires
  /// is_valid(name.key) and a world that exists. `now` is when it was asked, and becomes
  /// when that was known.
  PayloadRef at_once(const PayloadName& name, Instant& now);
  /// Joins or starts the job that makes it.
  Answer make(const PayloadName& name, const Asker& asker, Done done);
  /// The one, then the other.
  Answer request(const PayloadName& name, const Asker& asker, Done done);

  /// Chunks being made or waiting to be.
  std::size_t flights() const;

 private:
  struct Waiter {
    std::uint64_t id = 0;
    Asker asker;
    Done done;
  };
  struct Flight {
    JobPool::JobRef job;
    std::vector<Waiter> waiters;
  };

  PayloadRef ruled_out(const PayloadName& name);
  Answer join_or_start(const PayloadName& name, const Asker& asker, Done done, JobPool::JobRef& displaced);
  void run(const PayloadName& name, std::uint64_t flight_id, const JobPool::Context& context);
  void build(const PayloadName& name, std::uint64_t flight_id, const JobPool::Context& context);
  void fail(const PayloadName& name, std::uint64_t flight_id, std::string_view fault);
  /// Shared by a job and whoever gives it up; under mutex_.
  struct JobEnd {
    bool is_reached = false;
  };
  void give_up(const PayloadName& name, std::uint64_t flight_id, const JobEnd& end);
  void end(const PayloadName& name, JobEnd& end);
  void publish(const PayloadName& name, std::uint64_t flight_id, ChunkResult result);
  void set_urgency(const PayloadName& name, std::uint64_t id, Lane lane, double urgency);
  void follow_waiters(const Flight& flight);
  void drop(const PayloadName& name, std::uint64_t id);

  MemoryCache& cache_;
  StoredChunks& stored_;
  JobPool& pool_;
  ChunkBuilder& builder_;
  const Clock& clock_;
  Metrics& metrics_;
  const PayloadRef air_ = std::make_shared<const ChunkPayload>(ChunkPayload{ChunkKind::kAir, {}, 0});
  const PayloadRef rock_ = std::make_shared<const ChunkPayload>(ChunkPayload{ChunkKind::kRock, {}, 0});

  mutable std::mutex mutex_;
  std::uint64_t last_id_ = 0;
  struct Entry {
    std::uint64_t id = 0;  ///< a flight that was given up and begun anew has another
    Flight flight;
  };
  std::unordered_map<PayloadName, Entry, PayloadNameHash> flights_;
  std::vector<PayloadName> hung_;  ///< one for each thread of the pool that hangs
};

}  // namespace talus::server
