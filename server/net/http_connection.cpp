#include "server/net/http_connection.hpp"

#include <array>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/check.hpp"
#include "server/net/answer_writer.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/http_request.hpp"
#include "server/net/pool_answers.hpp"
#include "server/net/request_id.hpp"
#include "server/net/stream_session.hpp"
#include "server/net/websocket_handshake.hpp"
#include "server/observe/log.hpp"

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
        request_ids_(net.request_numbers.fetch_add(1, std::memory_order_relaxed), net.clock.now()),
        scanner_(limits_),
        client_(pass_.client),
        allow_origin_(policy_->origins.allow_field(std::nullopt)),
        writer_(net, channel_),
        answers_(net, executor_) {
    set_deadline(limits_.silent_s, Count::kSilentTimeout);
    net_.policy.refresh(present_, present_version_);
  }

  Awaitable<void> run();
  /// Once, before `run`: what the pool makes for this connection keeps it alive.
  void begin() { answers_.belong_to(weak_from_this()); }
  void sweep(Instant now) override;
  void drain() override;
  void abort() override;

 private:
  /// What a request waits for once `serve_now` has done what can be done without waiting.
  enum class Left : std::uint8_t { kNothing, kMaking, kSending, kRefusing };

  void receive(std::size_t bytes);
  bool serve_now(std::string_view head);
  Awaitable<void> serve(std::string_view head);
  void next_request(std::size_t head_bytes);
  void begin_request(const HttpRequest& request);
  bool answer_now(Route& route, Instant now);
  Awaitable<void> refuse(HttpFault fault);
  Awaitable<void> upgrade(const StreamRoute& route, std::string_view head);
  std::optional<HttpAnswer> refuse_upgrade(const HttpRequest& request);
  void send(HttpAnswer&& answer);
  void note(AnswerWriter::State state);
  Awaitable<void> send_rest();
  Awaitable<void> linger();

  void set_deadline(double s, Count reason) {
    deadline_ = sweeper().coarse_now() + seconds(s);
    deadline_reason_ = reason;
  }

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  Channel channel_;
  ConnectionPass pass_;
  const Door door_;
  const PolicyRef policy_;  ///< outlives the pass, which a stream takes over
  const NetLimits& limits_;
  PolicyRef present_;  ///< keys may have changed since the connection came: what opens a world is judged by the newest
  std::uint64_t present_version_ = 0;
  RequestIds request_ids_;
  HeadScanner scanner_;
  std::vector<char> input_;  ///< [0, input_size_) is received and not answered
  std::size_t input_size_ = 0;
  Instant deadline_ = Instant::max();
  Count deadline_reason_ = Count::kSilentTimeout;
  bool is_serving_ = true;  ///< there will be another request
  bool is_keep_alive_ = true;
  bool is_draining_ = false;
  bool is_idle_ = true;  ///< between requests
  std::uint64_t requests_ = 0;

  // The present request.
  bool is_http_1_0_ = false;
  bool is_head_only_ = false;
  bool has_body_ = false;
  std::string_view path_;          ///< of the head, in input_
  std::string_view request_id_;    ///< of the head or of request_ids_: until the next request
  ClientId client_;                ///< whose share of the pool it takes
  std::string_view allow_origin_;  ///< of the policy
  Route route_;
  Left left_ = Left::kNothing;
  HttpFault fault_{};
  AnswerWriter writer_;
  PoolAnswers answers_;
};

Awaitable<void> HttpConnection::run() {
  while (is_serving_) {
    const auto length = scanner_.scan(std::string_view(input_.data(), input_size_));
    if (!length) {
      request_id_ = request_ids_.next();
      co_await refuse(length.error());
    } else if (*length) {
      const std::string_view head(input_.data(), **length);
      if (!serve_now(head)) co_await serve(head);
      if (is_serving_) next_request(head.size());
    } else {
      // The scanner refuses before this is ever needed, so memory is bounded by the head's limits.
      if (input_.size() < input_size_ + kHeadReadBytes) input_.resize(input_size_ + kHeadReadBytes);
      const asio::mutable_buffer into(input_.data() + input_size_, input_.size() - input_size_);
      Channel::Read read;
      if (Socket* clear = channel_.in_clear()) {  // saves a coroutine's frame for each request
        const auto [error, got] = co_await clear->async_read_some(into, kAwait);
        read = {error, got};
      } else {
        read = co_await channel_.read_some(into);
      }
      read.error ? void(is_serving_ = false) : receive(read.bytes);
    }
  }
  channel_.close();
}

void HttpConnection::receive(std::size_t bytes) {
  if (input_size_ != 0) {
    input_size_ += bytes;
    return;
  }
  is_idle_ = false;
  set_deadline(limits_.head_s, Count::kHeadTimeout);
  // An empty line before a request is ignored (RFC 9112, 2.2); more of them are not.
  const std::size_t skipped = bytes >= 2 && input_[0] == '\r' && input_[1] == '\n' ? 2 : 0;
  if (skipped != 0) std::memmove(input_.data(), input_.data() + skipped, bytes - skipped);
  input_size_ = bytes - skipped;
}

/// All of it, if nothing has to be waited for, which is so for whatever is in memory and a peer that keeps up. False
/// when `serve` has to go on.
bool HttpConnection::serve_now(std::string_view head) {
  is_idle_ = false;
  deadline_ = Instant::max();
  left_ = Left::kNothing;
  const Instant start = net_.clock.now();
  HttpRequest request;
  if (const auto fault = parse_head_into(head, limits_, request)) {
    request_id_ = request_ids_.next();
    fault_ = *fault;
    left_ = Left::kRefusing;
    return false;
  }
  begin_request(request);
  const RouteContext context{net_.worlds,
                             net_.files,
                             net_.worlds_json,
                             door_,
                             net_.is_ready.load(std::memory_order_relaxed),
                             &present_->tokens,
                             sweeper().unix_seconds()};
  route_ = resolve(request, context);
  const Instant resolved = net_.clock.now();
  net_.metrics.record(Hop::kReadLoop, resolved - start);
  if (!answer_now(route_, resolved)) left_ = Left::kMaking;
  return left_ == Left::kNothing && !has_body_;
}

void HttpConnection::begin_request(const HttpRequest& request) {
  is_http_1_0_ = request.is_http_1_0;
  is_head_only_ = request.method == HttpMethod::kHead;
  has_body_ = request.has_body;
  path_ = request.path;
  is_keep_alive_ = request.is_keep_alive && !request.has_body && !is_draining_;
  if (++requests_ >= limits_.requests_per_connection && is_keep_alive_) {
    net_.metrics.add(Count::kRequestsExhausted);
    is_keep_alive_ = false;
  }
  request_id_ = request_ids_.of(request.field("x-request-id"));
  if (pass_.is_proxy) client_ = client_of_address(counted_address(policy_->proxies.client_of(pass_.address, request)));
  allow_origin_ = policy_->origins.allow_field(request.field("origin"));
  net_.policy.refresh(present_, present_version_);
}

/// False when the answer has to be made.
bool HttpConnection::answer_now(Route& route, Instant now) {
  if (auto* at_once = std::get_if<AnswerRoute>(&route)) {
    if (at_once->token_fault) net_.metrics.add(count_of(*at_once->token_fault));
    send(std::move(at_once->answer));
  } else if (const auto* chunk = std::get_if<ChunkRoute>(&route)) {
    PayloadRef payload = net_.chunks.at_once(chunk->name, now);
    if (payload == nullptr) return false;
    net_.metrics.add(Count::kHttpChunkInMemory);
    const std::string& etag = net_.worlds[chunk->name.world]->etag(chunk->name);
    send(chunk_answer(std::move(payload), etag, chunk->name.format));
  } else if (std::holds_alternative<MetricsRoute>(route)) {
    HttpAnswer answer;
    answer.content_type = "text/plain; version=0.0.4; charset=utf-8";
    answer.text = net_.metrics.text();
    send(std::move(answer));
  } else {
    return false;
  }
  return true;
}

/// What `serve_now` has left.
Awaitable<void> HttpConnection::serve(std::string_view head) {
  if (left_ == Left::kRefusing) {
    co_await refuse(fault_);
    co_return;
  }
  if (left_ == Left::kMaking && std::holds_alternative<StreamRoute>(route_)) {
    co_await upgrade(std::get<StreamRoute>(route_), head);
    co_return;
  }
  if (left_ == Left::kMaking) {
    HttpAnswer answer = co_await answers_.make(std::move(route_), client_);
    send(std::move(answer));
  }
  co_await send_rest();
  if (is_serving_ && has_body_) co_await linger();
}

void HttpConnection::next_request(std::size_t head_bytes) {
  if (!is_keep_alive_) {
    is_serving_ = false;
    return;
  }
  input_size_ -= head_bytes;
  if (input_size_ != 0) std::memmove(input_.data(), input_.data() + head_bytes, input_size_);
  scanner_.reset();
  is_idle_ = input_size_ == 0;
  if (is_idle_ && is_draining_) is_serving_ = false;
  is_idle_ ? set_deadline(limits_.idle_s, Count::kIdleTimeout) : set_deadline(limits_.head_s, Count::kHeadTimeout);
}

Awaitable<void> HttpConnection::refuse(HttpFault fault) {
  net_.metrics.add(count_of_refusal(fault.status));
  is_keep_alive_ = false;
  is_head_only_ = false;
  path_ = {};
  send(error_answer(fault.status, fault.code, fault.message));
  co_await send_rest();
  if (is_serving_) co_await linger();
  is_serving_ = false;
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

Awaitable<void> HttpConnection::upgrade(const StreamRoute& route, std::string_view head) {
  HttpRequest request;
  TALUS_CHECK(!parse_head_into(head, limits_, request));
  auto handshake = websocket_handshake(request);
  if (handshake) {
    if (auto refusal = refuse_upgrade(request)) handshake = std::unexpected(std::move(*refusal));
  }
  if (!handshake) {
    send(std::move(handshake.error()));
    co_await send_rest();
    co_return;
  }
  handshake->insert(handshake->size() - 2, "X-Request-Id: " + std::string(request_id_) + "\r\n");
  note(writer_.begin_head(std::move(*handshake)));
  co_await send_rest();
  if (!is_serving_) co_return;
  is_serving_ = false;
  StreamStart start;
  start.framing = make_websocket_framing(limits_.message_bytes);
  start.world = route.world;
  start.is_admitted = route.is_admitted;
  start.request_id = request_id_;
  const auto rest = std::as_bytes(std::span(input_.data() + head.size(), input_size_ - head.size()));
  start.received.assign(rest.begin(), rest.end());
  deadline_ = Instant::max();
  start_stream_session(net_, sweeper(), std::move(channel_), std::move(pass_), std::move(start));
}

/// Sends `answer` as the present request's; what is not taken at once is left.
void HttpConnection::send(HttpAnswer&& answer) {
  if (!present_->tokens.empty() && answer.cache_control == kImmutable) answer.cache_control = kImmutablePrivate;
  const HeadOptions options{sweeper().http_date(),     is_keep_alive_, is_http_1_0_, allow_origin_,
                            !policy_->origins.empty(), request_id_};
  const LogLevel level = answer.is_fault ? LogLevel::kError : LogLevel::kDebug;
  if (is_logged(level)) {
    log(level, "request",
        {{"request", request_id_},
         {"path", path_},
         {"status", std::int64_t{answer.status}},
         {"body_bytes", std::uint64_t{answer.body().size()}}});
  }
  note(writer_.begin(std::move(answer), options, is_head_only_));
}

void HttpConnection::note(AnswerWriter::State state) {
  left_ = state == AnswerWriter::State::kUnsent ? Left::kSending : Left::kNothing;
  if (state == AnswerWriter::State::kFailed) is_serving_ = false;
}

Awaitable<void> HttpConnection::send_rest() {
  if (left_ != Left::kSending) co_return;
  const bool is_sent = co_await writer_.finish();
  if (!is_sent) is_serving_ = false;
  deadline_ = Instant::max();
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
  if (const auto pace = writer_.judge_pace(now, limits_); pace != ReadPace::Verdict::kFine) {
    net_.metrics.add(count_of(pace));
    writer_.end_wait();
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
