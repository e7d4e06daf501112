#include "server/net/pool_answers.hpp"

#include <exception>
#include <utility>

#include "server/net/tileset_routes.hpp"
#include "server/observe/log.hpp"
#include "server/world/place_query.hpp"

namespace talus::server {

namespace {

/// A standing place looks at thousands of columns, a thousand points at four each.
constexpr double kQueryCostS = 0.005;

}  // namespace

Awaitable<HttpAnswer> PoolAnswers::make(Route route, ClientId client) {
  Question question;
  std::size_t world = 0;
  if (const auto* chunk_route = std::get_if<ChunkRoute>(&route)) {
    co_return co_await chunk(chunk_route->name, client);
  }
  if (const auto* spawn = std::get_if<SpawnRoute>(&route)) {
    world = spawn->world;
    question = [near_m = spawn->near_m](const World& of) {
      return spawn_answer(standing_place(of.function(), near_m));
    };
  } else if (auto* points = std::get_if<PointsRoute>(&route)) {
    world = points->world;
    question = [places = std::move(points->places_m)](const World& of) {
      return json_answer(points_json(of.function(), places));
    };
  } else if (const auto* ray = std::get_if<RayRoute>(&route)) {
    world = ray->world;
    question = [ray = *ray](const World& of) {
      return json_answer(ray_json(of.function(), ray.from_m, ray.direction, ray.max_m));
    };
  } else {
    const auto& tileset = std::get<TilesetRoute>(route);
    world = tileset.world;
    question = [place = tileset.place](const World& of) { return tileset_answer(of, place); };
  }
  co_return co_await ask(world, client, std::move(question));
}

Awaitable<HttpAnswer> PoolAnswers::chunk(PayloadName name, ClientId client) {
  net_.metrics.add(Count::kHttpChunkFromPool);
  const std::uint64_t asked = ++asked_;
  ChunkService::Done done = [this, owner = owner_.lock(), asked](ChunkResult result) mutable {
    asio::post(executor_, [this, owner = std::move(owner), asked, result = std::move(result)]() mutable {
      if (asked != asked_ || !waiting_since_) return;
      chunk_result_ = std::move(result);
      bell_.ring();
    });
  };
  ChunkService::Answer answer = net_.chunks.make(name, {client, Lane::kView, 0.0}, std::move(done));
  ChunkResult result = std::unexpected(ChunkError::kBusy);
  if (auto* payload = std::get_if<PayloadRef>(&answer)) {
    result = std::move(*payload);
  } else if (const auto* error = std::get_if<ChunkError>(&answer)) {
    result = std::unexpected(*error);
  } else if (std::holds_alternative<ChunkService::Ticket>(answer)) {
    waiting_since_ = net_.clock.now();
    while (waiting_since_ && !chunk_result_) co_await bell_.wait();
    waiting_since_.reset();
    if (chunk_result_) result = std::move(*chunk_result_);
    chunk_result_.reset();
  }
  if (!result) {
    co_return result.error() == ChunkError::kBusy ? unavailable("busy", "too many chunks are being made: come again")
                                                  : faulty("chunk_failed", "this chunk could not be made");
  }
  co_return chunk_answer(std::move(*result), net_.worlds[name.world]->etag(name), name.format);
}

Awaitable<HttpAnswer> PoolAnswers::ask(std::size_t world, ClientId client, Question question) {
  const std::uint64_t asked = ++asked_;
  // Weak: a job that hangs must not keep a connection, nor with it the end of the server; and a job that is the last to
  // know one must not end it on a thread that is not its own.
  JobPool::Work work = [this, weak = owner_, asked, question = std::move(question),
                        &of = *net_.worlds[world]](const JobPool::Context& context) mutable {
    HttpAnswer answer;
    bool has_failed = false;
    try {
      if (!context.is_displaced) answer = question(of);
    } catch (const std::exception& fault) {
      log(LogLevel::kError, "query failed", {{"fault", std::string_view(fault.what())}});
      has_failed = true;
    }
    std::shared_ptr<void> owner = weak.lock();
    if (owner == nullptr) return;
    if (context.is_displaced) answer = unavailable("busy", "too many questions at once: come again");
    if (has_failed) answer = faulty("query_failed", "this question could not be answered");
    asio::post(executor_, [this, owner = std::move(owner), asked, answer = std::move(answer)]() mutable {
      if (asked != asked_ || !waiting_since_) return;
      query_result_ = std::move(answer);
      bell_.ring();
    });
  };
  JobPool::OnHang on_hang = [this, weak = owner_, asked] {
    std::shared_ptr<void> owner = weak.lock();
    if (owner == nullptr) return;
    log(LogLevel::kError, "query given up", {{"fault", "its job does not end"}});
    asio::post(executor_, [this, owner = std::move(owner), asked] {
      if (asked != asked_ || !waiting_since_) return;
      query_result_ = faulty("query_failed", "this question could not be answered");
      bell_.ring();
    });
  };
  const JobPool::Pushed pushed =
      net_.pool.push({client, Lane::kView, 0.0, kQueryCostS}, std::move(work), std::move(on_hang));
  JobPool::tell_displaced(pushed.displaced);
  const JobPool::JobRef job = pushed.job;
  if (job == nullptr) {
    net_.metrics.add(Count::kQueryShed);
    co_return unavailable("busy", "too many questions at once: come again");
  }
  waiting_since_ = net_.clock.now();
  while (waiting_since_ && !query_result_) co_await bell_.wait();
  waiting_since_.reset();
  if (!query_result_) {
    net_.pool.cancel(job);
    co_return unavailable("busy", "the answer took too long: come again");
  }
  HttpAnswer answer = std::move(*query_result_);
  query_result_.reset();
  co_return answer;
}

void PoolAnswers::give_up() {
  waiting_since_.reset();
  bell_.ring();
}

}  // namespace talus::server
