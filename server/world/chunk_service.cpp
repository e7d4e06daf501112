#include "server/world/chunk_service.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/observe/log.hpp"

namespace talus::server {

namespace {

void log_chunk(std::string_view event, const PayloadName& name, std::string_view fault) {
  log(LogLevel::kError, event,
      {{"world", std::uint64_t{name.world}},
       {"lod", std::int64_t{name.key.lod}},
       {"x", std::int64_t{name.key.x}},
       {"y", std::int64_t{name.key.y}},
       {"z", std::int64_t{name.key.z}},
       {"format", std::uint64_t{static_cast<unsigned>(name.format)}},
       {"fault", fault}});
}

}  // namespace

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

void ChunkService::Ticket::set_urgency(Lane lane, double urgency) {
  if (service_ != nullptr) service_->set_urgency(name_, id_, lane, urgency);
}

void ChunkService::Ticket::drop() {
  if (ChunkService* service = std::exchange(service_, nullptr)) service->drop(name_, id_);
}

ChunkService::ChunkService(MemoryCache& cache, StoredChunks& stored, JobPool& pool, ChunkBuilder& builder,
                           const Clock& clock, Metrics& metrics)
    : cache_(cache), stored_(stored), pool_(pool), builder_(builder), clock_(clock), metrics_(metrics) {}

ChunkService::Answer ChunkService::request(const PayloadName& name, const Asker& asker, Done done) {
  Instant now = clock_.now();
  if (PayloadRef payload = at_once(name, now)) return payload;
  return make(name, asker, std::move(done));
}

PayloadRef ChunkService::at_once(const PayloadName& name, Instant& now) {
  PayloadRef payload = cache_.load(name);
  const Instant start = std::exchange(now, clock_.now());
  const Duration took = now - start;
  metrics_.record(Hop::kLoad, took);
  if (payload != nullptr) {
    metrics_.add(Count::kChunkHit);
    metrics_.record(Hop::kRequest, took);
    return payload;
  }
  payload = ruled_out(name);
  if (payload == nullptr) return nullptr;
  now = clock_.now();
  metrics_.add(Count::kChunkRuledOut);
  metrics_.record(Hop::kRequest, now - start);
  return payload;
}

ChunkService::Answer ChunkService::make(const PayloadName& name, const Asker& asker, Done done) {
  const Instant start = clock_.now();
  JobPool::JobRef displaced;
  Answer answer = join_or_start(name, asker, std::move(done), displaced);
  JobPool::tell_displaced(displaced);
  metrics_.record(Hop::kRequest, clock_.now() - start);
  return answer;
}

/// Most chunks of a view are air or rock that bounds tell at once: they cost no job. What the bounds had to learn first
/// is remembered like a chunk that was built.
PayloadRef ChunkService::ruled_out(const PayloadName& name) {
  const auto known = builder_.ruled_out(name);
  if (!known) return nullptr;
  const PayloadRef& payload = known->kind == ChunkKind::kAir ? air_ : rock_;
  if (known->is_learnt) {
    cache_.store(name, payload);
    stored_.store(name, payload, DiskCache::Commit::kLater);
  }
  return payload;
}

ChunkService::Answer ChunkService::join_or_start(const PayloadName& name, const Asker& asker, Done done,
                                                 JobPool::JobRef& displaced) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t id = ++last_id_;
  if (const auto found = flights_.find(name); found != flights_.end()) {
    Flight& flight = found->second.flight;
    flight.waiters.push_back({id, asker, std::move(done)});
    pool_.claim(flight.job, asker.client);
    follow_waiters(flight);
    metrics_.add(Count::kChunkJoined);
    return Ticket{this, name, id};
  }
  // A flight is published to the cache before it leaves the table, so a chunk in neither has no flight.
  if (PayloadRef payload = cache_.load(name)) {
    metrics_.add(Count::kChunkHit);
    return payload;
  }
  if (std::ranges::find(hung_, name) != hung_.end()) {
    metrics_.add(Count::kChunkFailed);
    return ChunkError::kFailed;
  }
  const JobTerms terms{asker.client, asker.lane, asker.urgency, builder_.predicted_s(name)};
  const auto job_end = std::make_shared<JobEnd>();
  JobPool::Work work = [this, name, id, job_end, pushed = clock_.now()](const JobPool::Context& context) {
    metrics_.record(Hop::kQueue, clock_.now() - pushed);
    run(name, id, context);
    end(name, *job_end);
  };
  JobPool::Pushed pushed =
      pool_.push(terms, std::move(work), [this, name, id, job_end] { give_up(name, id, *job_end); });
  displaced = std::move(pushed.displaced);
  if (pushed.job == nullptr) {
    metrics_.add(pushed.is_over_share ? Count::kChunkOverShare : Count::kChunkShed);
    return ChunkError::kBusy;
  }
  Entry& entry = flights_[name];
  entry.id = id;
  entry.flight.job = std::move(pushed.job);
  entry.flight.waiters.push_back({id, asker, std::move(done)});
  return Ticket{this, name, id};
}

void ChunkService::run(const PayloadName& name, std::uint64_t flight_id, const JobPool::Context& context) {
  if (context.is_displaced) {
    metrics_.add(Count::kChunkDisplaced);
    return publish(name, flight_id, std::unexpected(ChunkError::kBusy));
  }
  const Instant start = clock_.now();
  build(name, flight_id, context);
  const double took_s = std::chrono::duration<double>(clock_.now() - start).count();
  pool_.charge(context.client, took_s - context.cost_s);
}

void ChunkService::build(const PayloadName& name, std::uint64_t flight_id, const JobPool::Context& context) {
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
    stored_.store(name, built, DiskCache::Commit::kNow);  // nobody waits for it
  } catch (const std::exception& fault) {
    fail(name, flight_id, fault.what());
  } catch (...) {
    fail(name, flight_id, "thrown, and no exception");
  }
}

void ChunkService::fail(const PayloadName& name, std::uint64_t flight_id, std::string_view fault) {
  metrics_.add(Count::kChunkFailed);
  log_chunk("chunk failed", name, fault);
  publish(name, flight_id, std::unexpected(ChunkError::kFailed));
}

void ChunkService::give_up(const PayloadName& name, std::uint64_t flight_id, const JobEnd& end) {
  metrics_.add(Count::kChunkHung);
  log_chunk("chunk given up", name, "its job does not end");
  {
    const std::lock_guard lock(mutex_);
    if (!end.is_reached) hung_.push_back(name);
  }
  publish(name, flight_id, std::unexpected(ChunkError::kFailed));
}

void ChunkService::end(const PayloadName& name, JobEnd& end) {
  const std::lock_guard lock(mutex_);
  end.is_reached = true;
  std::erase(hung_, name);
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

void ChunkService::set_urgency(const PayloadName& name, std::uint64_t id, Lane lane, double urgency) {
  const std::lock_guard lock(mutex_);
  const auto found = flights_.find(name);
  if (found == flights_.end()) return;
  Flight& flight = found->second.flight;
  const auto mine = std::ranges::find(flight.waiters, id, &Waiter::id);
  if (mine == flight.waiters.end()) return;
  mine->asker.lane = lane;
  mine->asker.urgency = urgency;
  follow_waiters(flight);
}

/// Under mutex_. Requires a waiter.
void ChunkService::follow_waiters(const Flight& flight) {
  Asker foremost = flight.waiters.front().asker;
  for (const Waiter& waiter : flight.waiters) {
    foremost.lane = std::min(foremost.lane, waiter.asker.lane);
    foremost.urgency = std::min(foremost.urgency, waiter.asker.urgency);
  }
  flight.job->urgency.store(foremost.urgency, std::memory_order_relaxed);
  pool_.move(flight.job, foremost.lane);
}

void ChunkService::drop(const PayloadName& name, std::uint64_t id) {
  Flight ended;  // destroyed outside the lock: a callback may own anything
  Waiter withdrawn;
  const std::lock_guard lock(mutex_);
  const auto found = flights_.find(name);
  if (found == flights_.end()) return;
  auto& waiters = found->second.flight.waiters;
  const auto mine = std::ranges::find(waiters, id, &Waiter::id);
  if (mine == waiters.end()) return;
  withdrawn = std::move(*mine);
  waiters.erase(mine);
  if (!waiters.empty()) {
    const ClientId client = withdrawn.asker.client;
    const bool is_last_of_client =
        std::ranges::none_of(waiters, [&](const Waiter& waiter) { return waiter.asker.client == client; });
    if (is_last_of_client) pool_.unclaim(found->second.flight.job, client);
    return follow_waiters(found->second.flight);
  }
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
