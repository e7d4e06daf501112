#include "server/net/http_connection.hpp"

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "server/net/answer_writer.hpp"
#include "server/net/head_buffer.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/http_request.hpp"
#include "server/net/pool_answers.hpp"
#include "server/net/request_id.hpp"
#include "server/net/stream_admission.hpp"
#include "server/net/stream_session.hpp"
#include "server/observe/log.hpp"

namespace talus::server {

namespace {

/// So many reads of one connection are answered in a row; then it is another's turn.
constexpr int kReadsInTurn = 16;
/// How long, and how much, a peer may go on sending after an answer that closes: closing at once would reset the
/// connection and take the answer from under the peer.
constexpr double kAnswerLingerS = 2;
constexpr std::size_t kLingerBytes = 64 * 1024;
/// A peer that has closed its side is taken for gone when its answer takes longer than this.
constexpr double kHalfClosedS = 1;

/// One connection: reads a head, answers, and again. All on one thread.
///
/// `go_on` does so without a coroutine, called whenever there may be something to read, as long as nothing else has to
/// be waited for; where something has, `serve` does, and then `go_on` has its turn again.
class HttpConnection final : public std::enable_shared_from_this<HttpConnection>,
                             public Swept,
                             private Channel::Reader {
 public:
  HttpConnection(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass, Door door)
      : Swept(sweeper),
        net_(net),
        executor_(channel->executor()),
        channel_(std::move(channel)),
        pass_(std::move(pass)),
        door_(door),
        policy_(pass_.policy),
        limits_(policy_->limits),
        request_ids_(net.request_numbers.fetch_add(1, std::memory_order_relaxed), net.clock.now()),
        input_(limits_),
        client_(pass_.client),
        allow_origin_(policy_->origins.allow_field(std::nullopt)),
        writer_(net, *channel_),
        answers_(net, executor_) {
    set_deadline(limits_.silent_s, Count::kSilentTimeout);
    net_.policy.refresh(present_, present_version_);
  }

  /// Once: lives until it ends.
  void begin();
  void sweep(Instant now) override;
  void drain() override;
  void abort() override;

 private:
  /// What a request waits for once `serve_now` has done what can be done without waiting.
  enum class Left : std::uint8_t { kNothing, kMaking, kSending, kRefusing };

  void readable() noexcept override {
    if (!is_waiting_) go_on();
  }
  void go_on() noexcept;
  void read_on();
  bool receive();
  bool serve_now(std::string_view head);
  void serve_waiting(std::size_t head_bytes);
  Awaitable<void> serve(std::string_view head);
  void next_request(std::size_t head_bytes);
  void begin_request(const HttpRequest& request);
  void begin_refusal(const HttpFault& fault);
  bool answer_now(Route& route, Instant now);
  Awaitable<void> refuse();
  Awaitable<void> upgrade(const StreamRoute& route, std::string_view head);
  void send(HttpAnswer&& answer, Instant now);
  void note(AnswerWriter::State state);
  Awaitable<void> send_rest();
  Awaitable<void> linger();
  void close();
  void end();

  void set_deadline(double s, Count reason) {
    deadline_ = sweeper().coarse_now() + seconds(s);
    deadline_reason_ = reason;
  }

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  std::unique_ptr<Channel> channel_;  ///< until a stream takes it over
  ConnectionPass pass_;
  const Door door_;
  const PolicyRef policy_;  ///< outlives the pass, which a stream takes over
  const NetLimits& limits_;
  PolicyRef present_;  ///< keys may have changed since the connection came: what opens a world is judged by the newest
  std::uint64_t present_version_ = 0;
  RequestIds request_ids_;
  HeadBuffer input_;
  Instant deadline_ = Instant::max();
  Count deadline_reason_ = Count::kSilentTimeout;
  std::shared_ptr<HttpConnection> self_;  ///< until the end
  bool is_serving_ = true;                ///< there will be another request
  bool is_waiting_ = false;               ///< a coroutine is at work for the present request
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
  HttpFault fault_{};  ///< of kRefusing
  AnswerWriter writer_;
  PoolAnswers answers_;
};

void HttpConnection::begin() {
  self_ = shared_from_this();
  answers_.belong_to(self_);
  channel_->tell(this);
}

/// Does what can be done without waiting.
void HttpConnection::go_on() noexcept {
  try {
    read_on();
  } catch (const std::exception&) {
    net_.metrics.add(Count::kConnectionFault);
    is_serving_ = is_waiting_ = false;  // what throws here has not begun to wait
  }
  if (!is_serving_ && !is_waiting_) end();
}

void HttpConnection::read_on() {
  for (int reads = 0; is_serving_;) {
    const auto length = input_.head_bytes();
    if (!length) {
      begin_refusal(length.error());
      return serve_waiting(0);
    }
    if (*length) {
      if (!serve_now(input_.first(**length))) return serve_waiting(**length);
      if (is_serving_) next_request(**length);
    } else if (reads++ == kReadsInTurn) {
      return asio::post(executor_, [this, self = self_] { readable(); });
    } else if (!receive()) {
      return;
    }
  }
}

/// False when there is nothing yet.
bool HttpConnection::receive() {
  const auto [error, got] = channel_->read_now(input_.room());
  if (error == asio::error::would_block) return false;
  is_serving_ = !error;
  if (error) return true;
  if (input_.empty()) set_deadline(limits_.head_s, Count::kHeadTimeout);
  is_idle_ = false;
  input_.receive(got);
  return true;
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
    begin_refusal(*fault);
    return false;
  }
  begin_request(request);
  const bool is_ready = net_.is_ready.load(std::memory_order_relaxed);
  route_ = resolve(request, {net_.worlds, net_.files, net_.worlds_json, door_, is_ready, &present_->tokens,
                             sweeper().unix_seconds()});
  const Instant resolved = net_.clock.now();
  net_.metrics.record(Hop::kReadLoop, resolved - start);
  if (!answer_now(route_, resolved)) left_ = Left::kMaking;
  return left_ == Left::kNothing && !has_body_;
}

void HttpConnection::begin_refusal(const HttpFault& fault) {
  request_id_ = request_ids_.next();
  fault_ = fault;
  left_ = Left::kRefusing;
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
    send(std::move(at_once->answer), now);
  } else if (const auto* chunk = std::get_if<ChunkRoute>(&route)) {
    PayloadRef payload = net_.chunks.at_once(chunk->name, now);
    if (payload == nullptr) return false;
    net_.metrics.add(Count::kHttpChunkInMemory);
    const std::string& etag = net_.worlds[chunk->name.world]->etag(chunk->name);
    send(chunk_answer(std::move(payload), etag, chunk->name.format), now);
  } else if (std::holds_alternative<MetricsRoute>(route)) {
    HttpAnswer answer = metrics_answer(net_.metrics);
    send(std::move(answer), net_.clock.now());  // writing begins behind what makes the text
  } else {
    return false;
  }
  return true;
}

/// What `serve_now` has left of the first `head_bytes` that were received; reads on behind it.
void HttpConnection::serve_waiting(std::size_t head_bytes) {
  is_waiting_ = true;
  asio::co_spawn(executor_, serve(input_.first(head_bytes)),
                 [this, self = self_, head_bytes](const std::exception_ptr& fault) {
                   is_waiting_ = false;
                   if (fault != nullptr) {
                     net_.metrics.add(Count::kConnectionFault);
                     is_serving_ = false;
                   }
                   if (is_serving_) next_request(head_bytes);
                   go_on();
                 });
}

Awaitable<void> HttpConnection::serve(std::string_view head) {
  if (left_ == Left::kRefusing) co_return co_await refuse();
  if (left_ == Left::kMaking) {
    if (const auto* stream = std::get_if<StreamRoute>(&route_)) co_return co_await upgrade(*stream, head);
    HttpAnswer answer = co_await answers_.make(std::move(route_), client_);
    send(std::move(answer), net_.clock.now());
  }
  co_await send_rest();
  if (is_serving_ && has_body_) co_await linger();
}

void HttpConnection::next_request(std::size_t head_bytes) {
  if (!is_keep_alive_) {
    is_serving_ = false;
    return;
  }
  input_.drop(head_bytes);
  is_idle_ = input_.empty();
  if (is_idle_ && is_draining_) is_serving_ = false;
  is_idle_ ? set_deadline(limits_.idle_s, Count::kIdleTimeout) : set_deadline(limits_.head_s, Count::kHeadTimeout);
}

Awaitable<void> HttpConnection::refuse() {
  net_.metrics.add(count_of_refusal(fault_.status));
  is_keep_alive_ = false;
  is_head_only_ = false;
  path_ = {};
  send(error_answer(fault_.status, fault_.code, fault_.message), net_.clock.now());
  co_await send_rest();
  if (is_serving_) co_await linger();
  is_serving_ = false;
}

Awaitable<void> HttpConnection::upgrade(const StreamRoute& route, std::string_view head) {
  auto handshake = stream_handshake(net_, pass_, head, request_id_);
  if (!handshake) {
    send(std::move(handshake.error()), net_.clock.now());
    co_await send_rest();
    co_return;
  }
  note(writer_.begin_head(std::move(*handshake)));
  co_await send_rest();
  if (!is_serving_) co_return;
  is_serving_ = false;
  StreamStart start;
  start.framing = make_websocket_framing(limits_.message_bytes);
  start.world = route.world;
  start.is_admitted = route.is_admitted;
  start.request_id = request_id_;
  const auto rest = input_.behind(head.size());
  start.received.assign(rest.begin(), rest.end());
  deadline_ = Instant::max();
  channel_->tell(nullptr);
  start_stream_session(net_, sweeper(), std::move(channel_), std::move(pass_), std::move(start));
}

/// Sends `answer` as the present request's; what is not taken at once is left.
void HttpConnection::send(HttpAnswer&& answer, Instant now) {
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
  note(writer_.begin(std::move(answer), options, is_head_only_, now));
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
  set_deadline(kAnswerLingerS, Count::kEnd);
  co_await channel_->hear_out(kLingerBytes);
}

void HttpConnection::sweep(Instant now) {
  if (channel_ == nullptr) return;
  if (const auto since = answers_.waiting_since()) {
    // A ticket is dropped as soon as nobody waits behind this connection.
    const bool is_gone = now - *since > seconds(kHalfClosedS) && channel_->is_peer_gone();
    if (is_gone || now - *since >= seconds(limits_.wait_s)) answers_.give_up();
    return;
  }
  if (const auto pace = writer_.judge_pace(now, limits_); pace != ReadPace::Verdict::kFine) {
    net_.metrics.add(count_of(pace));
    writer_.end_wait();
    return channel_->reset();
  }
  if (now < deadline_) return;
  deadline_ = Instant::max();
  if (deadline_reason_ != Count::kEnd) net_.metrics.add(deadline_reason_);
  close();
}

void HttpConnection::drain() {
  if (door_ == Door::kAdmin) return;
  is_draining_ = true;
  is_keep_alive_ = false;
  if (is_idle_) close();
}

void HttpConnection::abort() {
  if (channel_ != nullptr) channel_->reset();
  close();
  answers_.give_up();
}

/// Whoever waits for the channel hears of it and ends.
void HttpConnection::close() {
  if (channel_ != nullptr) channel_->close();
  is_serving_ = false;
  if (!is_waiting_) end();
}

void HttpConnection::end() {
  if (channel_ != nullptr) channel_->close();
  deadline_ = Instant::max();
  // Destroyed later: a member function of this may be what ends it.
  if (self_ != nullptr) asio::post(executor_, [self = std::move(self_)] {});
}

}  // namespace

void start_http_connection(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                           Door door) {
  std::make_shared<HttpConnection>(net, sweeper, std::move(channel), std::move(pass), door)->begin();
}

}  // namespace talus::server
