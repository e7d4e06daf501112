#include "server/net/http_connection.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/check.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/http_request.hpp"
#include "server/net/pool_answers.hpp"
#include "server/net/read_pace.hpp"
#include "server/net/stream_session.hpp"
#include "server/net/tileset_routes.hpp"
#include "server/net/websocket_handshake.hpp"
#include "server/observe/log.hpp"
#include "server/world/place_query.hpp"

namespace talus::server {

namespace {

constexpr std::size_t kHeadReadBytes = 4096;
/// How long, and how much, a peer may go on sending after an answer that closes: closing at once would reset the
/// connection and take the answer from under the peer.
constexpr double kAnswerLingerS = 2;
constexpr std::size_t kLingerBytes = 64 * 1024;
/// A peer that has closed its side is taken for gone when its answer takes longer than this.
constexpr double kHalfClosedS = 1;

/// One connection: reads a head, answers, and again. All on one thread.
class HttpConnection final : public std::enable_shared_from_this<HttpConnection>, public Swept {
 public:
  HttpConnection(NetContext& net, Sweeper& sweeper, Channel channel, ConnectionPass pass, Door door)
      : Swept(sweeper),
        net_(net),
        executor_(channel.executor()),
        channel_(std::move(channel)),
        pass_(std::move(pass)),
        door_(door),
        policy_(pass_.policy),
        limits_(policy_->limits),
        scanner_(limits_),
        client_(pass_.client),
        allow_origin_(policy_->origins.allow_field(std::nullopt)),
        answers_(net, executor_) {
    set_deadline(limits_.silent_s, Count::kSilentTimeout);
  }

  Awaitable<void> run();
  /// Once, before `run`: what the pool makes for this connection keeps it alive.
  void begin() { answers_.belong_to(weak_from_this()); }
  void sweep(Instant now) override;
  void drain() override;
  void abort() override;

 private:
  using Question = PoolAnswers::Question;
  enum class Next { kRequest, kEnd };

  Awaitable<bool> read_more();
  Awaitable<Next> serve(std::string_view head);
  Awaitable<Next> refuse(HttpFault fault);
  Awaitable<Next> upgrade(const StreamRoute& route, std::string_view head);
  std::optional<HttpAnswer> refuse_upgrade(const HttpRequest& request);
  Awaitable<bool> send(HttpAnswer answer, bool is_head_only);
  Awaitable<bool> write_all(std::array<asio::const_buffer, 2> buffers);
  Awaitable<void> linger();

  void set_deadline(double s, Count reason) {
    deadline_ = net_.clock.now() + seconds(s);
    deadline_reason_ = reason;
  }

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  Channel channel_;
  ConnectionPass pass_;
  const Door door_;
  const PolicyRef policy_;  ///< outlives the pass, which a stream takes over
  const NetLimits& limits_;
  HeadScanner scanner_;
  std::vector<char> input_;  ///< [0, input_size_) is received and not answered
  std::size_t input_size_ = 0;
  std::string head_;  ///< of the answer being sent
  Instant deadline_ = Instant::max();
  Count deadline_reason_ = Count::kSilentTimeout;
  bool is_keep_alive_ = true;
  bool is_http_1_0_ = false;
  bool is_draining_ = false;
  bool is_idle_ = true;  ///< between requests
  std::uint64_t requests_ = 0;

  ClientId client_;                ///< whose share of the pool the present request takes
  std::string_view allow_origin_;  ///< of the present request; of the policy
  PoolAnswers answers_;
  ReadPace pace_;
};

Awaitable<void> HttpConnection::run() {
  for (;;) {
    const auto length = scanner_.scan(std::string_view(input_.data(), input_size_));
    if (!length) {
      co_await refuse(length.error());
      break;
    }
    if (!*length) {
      if (!co_await read_more()) break;
      continue;
    }
    is_idle_ = false;
    deadline_ = Instant::max();
    const std::size_t head_bytes = **length;
    const Next next = co_await serve(std::string_view(input_.data(), head_bytes));
    if (next == Next::kEnd || !is_keep_alive_) break;
    std::memmove(input_.data(), input_.data() + head_bytes, input_size_ - head_bytes);
    input_size_ -= head_bytes;
    scanner_.reset();
    is_idle_ = input_size_ == 0;
    if (is_idle_ && is_draining_) break;
    if (is_idle_) {
      set_deadline(limits_.idle_s, Count::kIdleTimeout);
    } else {
      set_deadline(limits_.head_s, Count::kHeadTimeout);
    }
  }
  channel_.close();
}

Awaitable<bool> HttpConnection::read_more() {
  // The scanner refuses before this is ever needed, so memory is bounded by the head's limits.
  if (input_.size() < input_size_ + kHeadReadBytes) input_.resize(input_size_ + kHeadReadBytes);
  const asio::mutable_buffer into(input_.data() + input_size_, input_.size() - input_size_);
  const auto [error, got] = co_await channel_.read_some(into);
  if (error) co_return false;
  if (input_size_ == 0) {
    is_idle_ = false;
    set_deadline(limits_.head_s, Count::kHeadTimeout);
    // An empty line before a request is ignored (RFC 9112, 2.2); more of them are not.
    std::size_t skipped = 0;
    if (got >= 2 && input_[0] == '\r' && input_[1] == '\n') skipped = 2;
    std::memmove(input_.data(), input_.data() + skipped, got - skipped);
    input_size_ = got - skipped;
    co_return true;
  }
  input_size_ += got;
  co_return true;
}

Awaitable<HttpConnection::Next> HttpConnection::refuse(HttpFault fault) {
  net_.metrics.add(fault.status == 414   ? Count::kUriTooLong
                   : fault.status == 431 ? Count::kHeadTooLarge
                   : fault.status == 413 ? Count::kBodyTooLarge
                                         : Count::kBadRequest);
  is_keep_alive_ = false;
  HttpAnswer answer = error_answer(fault.status, fault.code, fault.message);
  if (co_await send(std::move(answer), false)) co_await linger();
  co_return Next::kEnd;
}

Awaitable<HttpConnection::Next> HttpConnection::serve(std::string_view head) {
  const Instant start = net_.clock.now();
  const auto request = parse_head(head, limits_);
  if (!request) co_return co_await refuse(request.error());
  is_http_1_0_ = request->is_http_1_0;
  is_keep_alive_ = request->is_keep_alive && !request->has_body && !is_draining_;
  if (++requests_ >= limits_.requests_per_connection && is_keep_alive_) {
    net_.metrics.add(Count::kRequestsExhausted);
    is_keep_alive_ = false;
  }
  if (pass_.is_proxy) client_ = client_of_address(counted_address(policy_->proxies.client_of(pass_.address, *request)));
  allow_origin_ = policy_->origins.allow_field(request->field("origin"));
  // Keys may have changed since this connection came: what opens a world is always judged by the newest.
  const PolicyRef present = net_.policy.load();
  const RouteContext context{net_.worlds,
                             net_.files,
                             net_.worlds_json,
                             door_,
                             net_.is_ready.load(std::memory_order_relaxed),
                             &present->tokens,
                             net_.clock.unix_seconds()};
  Route route = resolve(*request, context);
  net_.metrics.record(Hop::kReadLoop, net_.clock.now() - start);

  HttpAnswer answer;
  if (auto* at_once = std::get_if<AnswerRoute>(&route)) {
    if (at_once->token_fault) net_.metrics.add(count_of(*at_once->token_fault));
    answer = std::move(at_once->answer);
  } else if (const auto* chunk = std::get_if<ChunkRoute>(&route)) {
    answer = co_await answers_.chunk(chunk->name, client_);
  } else if (const auto* spawn = std::get_if<SpawnRoute>(&route)) {
    Question question = [near_m = spawn->near_m](const World& world) {
      return spawn_answer(standing_place(world.function(), near_m));
    };
    answer = co_await answers_.query(spawn->world, client_, std::move(question));
  } else if (auto* points = std::get_if<PointsRoute>(&route)) {
    Question question = [places = std::move(points->places_m)](const World& world) {
      return json_answer(points_json(world.function(), places));
    };
    answer = co_await answers_.query(points->world, client_, std::move(question));
  } else if (const auto* ray = std::get_if<RayRoute>(&route)) {
    Question question = [ray = *ray](const World& world) {
      return json_answer(ray_json(world.function(), ray.from_m, ray.direction, ray.max_m));
    };
    answer = co_await answers_.query(ray->world, client_, std::move(question));
  } else if (const auto* tileset = std::get_if<TilesetRoute>(&route)) {
    Question question = [place = tileset->place](const World& world) { return tileset_answer(world, place); };
    answer = co_await answers_.query(tileset->world, client_, std::move(question));
  } else if (const auto* stream = std::get_if<StreamRoute>(&route)) {
    co_return co_await upgrade(*stream, head);
  } else {
    answer.content_type = "text/plain; version=0.0.4; charset=utf-8";
    answer.text = net_.metrics.text();
  }
  if (!present->tokens.empty() && answer.cache_control == kImmutable) answer.cache_control = kImmutablePrivate;
  const bool is_head_only = request->method == HttpMethod::kHead;
  const bool was_sent = co_await send(std::move(answer), is_head_only);
  if (was_sent && request->has_body) co_await linger();
  co_return was_sent ? Next::kRequest : Next::kEnd;
}

/// What only this connection can say of a request that could be a WebSocket: whose page asks, and how many streams its
/// address has. Behind a proxy a stream counts for the one who is served.
std::optional<HttpAnswer> HttpConnection::refuse_upgrade(const HttpRequest& request) {
  if (!policy_->origins.admits(request.field("origin"))) {
    net_.metrics.add(Count::kOriginRefused);
    return error_answer(403, "origin_not_allowed", "Origin: pages of this origin may not stream from here");
  }
  if (!pass_.is_proxy) return std::nullopt;
  const PeerAddress address = counted_address(policy_->proxies.client_of(pass_.address, request));
  auto [verdict, place] =
      net_.census.enter(address, std::numeric_limits<std::size_t>::max(), limits_.connections_per_address);
  if (verdict == ConnectionCensus::Verdict::kWelcome) {
    pass_.place = std::move(place);
    return std::nullopt;
  }
  net_.metrics.add(Count::kConnectionsRefusedAddress);
  return error_answer(429, "connections_per_address", "too many streams of your address");
}

Awaitable<HttpConnection::Next> HttpConnection::upgrade(const StreamRoute& route, std::string_view head) {
  const auto request = parse_head(head, limits_);
  TALUS_CHECK(request.has_value());
  auto handshake = websocket_handshake(*request);
  if (handshake) {
    if (auto refusal = refuse_upgrade(*request)) handshake = std::unexpected(std::move(*refusal));
  }
  if (!handshake) {
    HttpAnswer answer = std::move(handshake.error());
    const bool is_head_only = request->method == HttpMethod::kHead;
    co_return co_await send(std::move(answer), is_head_only) ? Next::kRequest : Next::kEnd;
  }
  head_ = std::move(*handshake);
  const std::array<asio::const_buffer, 2> buffers{asio::buffer(head_), asio::const_buffer{}};
  if (!co_await write_all(buffers)) co_return Next::kEnd;
  StreamStart start;
  start.framing = make_websocket_framing(limits_.message_bytes);
  start.world = route.world;
  start.is_admitted = route.is_admitted;
  const auto rest = std::as_bytes(std::span(input_.data() + head.size(), input_size_ - head.size()));
  start.received.assign(rest.begin(), rest.end());
  deadline_ = Instant::max();
  start_stream_session(net_, sweeper(), std::move(channel_), std::move(pass_), std::move(start));
  co_return Next::kEnd;
}

Awaitable<bool> HttpConnection::send(HttpAnswer answer, bool is_head_only) {
  net_.metrics.add(count_of(answer.status));
  const HeadOptions options{sweeper().http_date(), is_keep_alive_, is_http_1_0_, allow_origin_,
                            !policy_->origins.empty()};
  write_head(answer, options, head_);
  const auto body = answer.body();
  const bool has_body = !is_head_only && answer.status != 204 && answer.status != 304;
  if (has_body) net_.metrics.add(Count::kHttpBodyBytes, body.size());
  const std::array<asio::const_buffer, 2> buffers{
      asio::buffer(head_), has_body ? asio::const_buffer(body.data(), body.size()) : asio::const_buffer{}};
  const Instant start = net_.clock.now();
  const bool was_sent = co_await write_all(buffers);
  net_.metrics.record(Hop::kWriteLoop, net_.clock.now() - start);
  co_return was_sent;
}

/// One gather write when the peer keeps up: it is tried at once, and waited for only if the kernel is full.
Awaitable<bool> HttpConnection::write_all(std::array<asio::const_buffer, 2> buffers) {
  for (;;) {
    asio::error_code error;
    std::size_t sent = channel_.write_some(buffers, error);
    if (error && error != asio::error::would_block) co_return false;
    if (pace_.is_waiting()) pace_.took(sent, net_.clock.now());
    for (asio::const_buffer& buffer : buffers) {
      const std::size_t of_this = std::min(sent, buffer.size());
      buffer += of_this;
      sent -= of_this;
    }
    if (buffers[0].size() + buffers[1].size() == 0) break;
    pace_.begin_wait(net_.clock.now());
    if (co_await channel_.wait_writable()) co_return false;
  }
  pace_.end_wait();
  deadline_ = Instant::max();
  co_return true;
}

Awaitable<void> HttpConnection::linger() {
  channel_.shutdown_send();
  set_deadline(kAnswerLingerS, Count::kEnd);
  std::array<char, kHeadReadBytes> dropped;
  for (std::size_t total = 0; total < kLingerBytes;) {
    const asio::mutable_buffer into(dropped.data(), dropped.size());
    const auto [error, got] = co_await channel_.read_some(into);
    if (error) break;
    total += got;
  }
}

void HttpConnection::sweep(Instant now) {
  if (const auto since = answers_.waiting_since()) {
    // A ticket is dropped as soon as nobody waits behind this connection.
    const bool is_gone = now - *since > seconds(kHalfClosedS) && channel_.is_peer_gone();
    if (is_gone || now - *since >= seconds(limits_.wait_s)) answers_.give_up();
    return;
  }
  if (const auto pace = pace_.judge(now, limits_); pace != ReadPace::Verdict::kFine) {
    net_.metrics.add(count_of(pace));
    pace_.end_wait();
    return channel_.reset();
  }
  if (now < deadline_) return;
  deadline_ = Instant::max();
  if (deadline_reason_ != Count::kEnd) net_.metrics.add(deadline_reason_);
  channel_.close();
}

void HttpConnection::drain() {
  if (door_ == Door::kAdmin) return;
  is_draining_ = true;
  is_keep_alive_ = false;
  if (is_idle_) channel_.close();
}

void HttpConnection::abort() {
  channel_.reset();
  answers_.give_up();
}

}  // namespace

void start_http_connection(NetContext& net, Sweeper& sweeper, Channel channel, ConnectionPass pass, Door door) {
  const auto executor = channel.executor();
  auto connection = std::make_shared<HttpConnection>(net, sweeper, std::move(channel), std::move(pass), door);
  HttpConnection& running = *connection;
  running.begin();
  asio::co_spawn(executor, running.run(), [connection = std::move(connection), &net](const std::exception_ptr& fault) {
    if (fault != nullptr) net.metrics.add(Count::kConnectionFault);
  });
}

}  // namespace talus::server
