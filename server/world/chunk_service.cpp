#include "server/world/chunk_service.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/observe/log.hpp"

namespace talus::server {

ChunkService::Ticket::Ticket(Ticket&& other) noexcept
    : service_(std::exchange(other.service_, nullptr)), name_(other.name_), id_(other.id_) {}

ChunkService::Ticket& ChunkService::Ticket::operator=(Ticket&& other) noexcept {
  if (this != &other) {
    drop();
    service_ = std::exchange(other.service_, nullptr);
    name_ = other.name_;
    id_ = other.id_;
  }
  return *this;
}

void ChunkService::Ticket::set_urgency(double urgency) {
  if (service_ != nullptr) service_->set_urgency(name_, id_, urgency);
}

void ChunkService::Ticket::drop() {
  if (ChunkService* service = std::exchange(service_, nullptr)) service->drop(name_, id_);
}

ChunkService::ChunkService(MemoryCache& cache, StoredChunks& stored, JobPool& pool, ChunkBuilder& builder,
                           const Clock& clock, Metrics& metrics)
    : cache_(cache), stored_(stored), pool_(pool), builder_(builder), clock_(clock), metrics_(metrics) {}

ChunkService::Answer ChunkService::request(const PayloadName& name, Lane lane, double urgency, Done done) {
  const Instant start = clock_.now();
  if (PayloadRef payload = load(name)) {
    metrics_.add(Count::kChunkHit);
    metrics_.record(Hop::kRequest, clock_.now() - start);
    return payload;
  }
  Answer answer = join_or_start(name, lane, urgency, std::move(done));
  metrics_.record(Hop::kRequest, clock_.now() - start);
  return answer;
}

PayloadRef ChunkService::load(const PayloadName& name) {
  const Instant start = clock_.now();
  PayloadRef payload = cache_.load(name);
  metrics_.record(Hop::kLoad, clock_.now() - start);
  return payload;
}

ChunkService::Answer ChunkService::join_or_start(const PayloadName& name, Lane lane, double urgency, Done done) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t id = ++last_id_;
  if (const auto found = flights_.find(name); found != flights_.end()) {
    Flight& flight = found->second.flight;
    flight.waiters.push_back({id, urgency, std::move(done)});
    if (urgency < flight.job->urgency.load(std::memory_order_relaxed)) {
      flight.job->urgency.store(urgency, std::memory_order_relaxed);
    }
    metrics_.add(Count::kChunkJoined);
    return Ticket{this, name, id};
  }
  // A flight is published to the cache before it leaves the table, so a chunk in neither has no flight.
  if (PayloadRef payload = cache_.load(name)) {
    metrics_.add(Count::kChunkHit);
    return payload;
  }
  JobPool::JobRef job =
      pool_.push(lane, urgency, [this, name, id](const JobPool::Context& context) { run(name, id, context); });
  if (job == nullptr) {
    metrics_.add(Count::kChunkShed);
    return ChunkError::kBusy;
  }
  Entry& entry = flights_[name];
  entry.id = id;
  entry.flight.job = std::move(job);
  entry.flight.waiters.push_back({id, urgency, std::move(done)});
  return Ticket{this, name, id};
}

void ChunkService::run(const PayloadName& name, std::uint64_t flight_id, const JobPool::Context& context) {
  if (std::optional<ChunkPayload> stored = stored_.load(name, context.thread)) {
    metrics_.add(Count::kChunkStored);
    return publish(name, flight_id, std::make_shared<const ChunkPayload>(std::move(*stored)));
  }
  try {
    std::optional<ChunkPayload> payload = builder_.build(name, context.thread, context.token);
    if (!payload) return;  // given up: the flight has left the table already
    metrics_.add(Count::kChunkBuilt);
    const auto built = std::make_shared<const ChunkPayload>(std::move(*payload));
    publish(name, flight_id, built);
    stored_.store(name, built);  // nobody waits for it
  } catch (const std::exception& fault) {
    metrics_.add(Count::kChunkFailed);
    log(LogLevel::kError, "chunk failed",
        {{"lod", std::int64_t{name.key.lod}},
         {"x", std::int64_t{name.key.x}},
         {"y", std::int64_t{name.key.y}},
         {"z", std::int64_t{name.key.z}},
         {"fault", std::string_view(fault.what())}});
    publish(name, flight_id, std::unexpected(ChunkError::kFailed));
  }
}

void ChunkService::publish(const PayloadName& name, std::uint64_t flight_id, ChunkResult result) {
  const Instant start = clock_.now();
  if (result) cache_.store(name, *result);
  std::vector<Waiter> waiters;
  {
    const std::lock_guard lock(mutex_);
    const auto found = flights_.find(name);
    if (found == flights_.end() || found->second.id != flight_id) return;
    waiters = std::move(found->second.flight.waiters);
    flights_.erase(found);
  }
  for (Waiter& waiter : waiters) waiter.done(result);
  metrics_.record(Hop::kPublish, clock_.now() - start);
}

void ChunkService::set_urgency(const PayloadName& name, std::uint64_t id, double urgency) {
  const std::lock_guard lock(mutex_);
  const auto found = flights_.find(name);
  if (found == flights_.end()) return;
  Flight& flight = found->second.flight;
  const auto mine =
      std::find_if(flight.waiters.begin(), flight.waiters.end(), [&](const Waiter& w) { return w.id == id; });
  if (mine == flight.waiters.end()) return;
  mine->urgency = urgency;
  const auto most = std::min_element(flight.waiters.begin(), flight.waiters.end(),
                                     [](const Waiter& a, const Waiter& b) { return a.urgency < b.urgency; });
  flight.job->urgency.store(most->urgency, std::memory_order_relaxed);
}

void ChunkService::drop(const PayloadName& name, std::uint64_t id) {
  Flight ended;  // destroyed outside the lock: a callback may own anything
  Waiter withdrawn;
  const std::lock_guard lock(mutex_);
  const auto found = flights_.find(name);
  if (found == flights_.end()) return;
  auto& waiters = found->second.flight.waiters;
  const auto mine = std::find_if(waiters.begin(), waiters.end(), [&](const Waiter& w) { return w.id == id; });
  if (mine == waiters.end()) return;
  withdrawn = std::move(*mine);
  waiters.erase(mine);
  if (!waiters.empty()) return;
  ended = std::move(found->second.flight);
  flights_.erase(found);
  pool_.cancel(ended.job);
  metrics_.add(Count::kChunkCancelled);
}

std::size_t ChunkService::flights() const {
  const std::lock_guard lock(mutex_);
  return flights_.size();
}

}  // namespace talus::server
