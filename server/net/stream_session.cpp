#include "server/net/stream_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <unordered_map>
#include <utility>

#include "core/base/hash.hpp"
#include "protocol/limits.hpp"
#include "protocol/message.hpp"
#include "server/net/send_queue.hpp"
#include "server/net/token_bucket.hpp"
#include "server/observe/log.hpp"
#include "server/world/viewer.hpp"

namespace talus::server {

namespace {

using protocol::ByeReason;
using protocol::Message;
using protocol::RefusedReason;

constexpr std::size_t kReadBytes = 16 * 1024;
/// Nothing is requested while this much is queued: what is queued can no longer be overtaken by what is nearer.
constexpr std::size_t kPumpBelowBytes = 256 * 1024;
constexpr std::size_t kBatchFrames = 16;
constexpr std::size_t kBatchBytes = 128 * 1024;
/// Chunks in the making, of all sessions together: most of what a lane of the pool queues.
constexpr std::size_t kWindowsSum = 192;
constexpr std::size_t kWindowMin = 2;
constexpr double kLingerS = 2;
constexpr double kRetryS = 0.1;  ///< after the pool was full
/// A view is turned into an interest area at most this often, and never for more than 1/20 of a thread's time.
constexpr double kRefreshS = 0.05;
constexpr double kRefreshShare = 20;
constexpr double kMessageBytesPerToken = 4096;

CloseCode close_code(ByeReason reason) {
  switch (reason) {
    case ByeReason::kLeaving:
      return CloseCode::kNormal;
    case ByeReason::kDraining:
      return CloseCode::kGoingAway;
    case ByeReason::kMalformed:
      return CloseCode::kProtocol;
    case ByeReason::kInternal:
      return CloseCode::kInternal;
    case ByeReason::kTooManyMessages:
    case ByeReason::kTooSlow:
    case ByeReason::kSilent:
      return CloseCode::kPolicy;
  }
  return CloseCode::kInternal;
}

Count count_of(ByeReason reason) {
  switch (reason) {
    case ByeReason::kMalformed:
      return Count::kByeMalformed;
    case ByeReason::kTooManyMessages:
      return Count::kByeTooManyMessages;
    case ByeReason::kTooSlow:
      return Count::kByeTooSlow;
    case ByeReason::kSilent:
      return Count::kByeSilent;
    case ByeReason::kDraining:
      return Count::kByeDraining;
    case ByeReason::kLeaving:
    case ByeReason::kInternal:
      return Count::kByeInternal;
  }
  return Count::kByeInternal;
}

/// One streaming client. All on one thread; pool threads post to it.
class StreamSession final : public std::enable_shared_from_this<StreamSession>, public Swept {
 public:
  StreamSession(NetContext& net, Sweeper& sweeper, Socket socket, ConnectionPass pass, StreamStart start);
  ~StreamSession() override;

  Awaitable<void> read_loop();
  Awaitable<void> write_loop();
  void sweep(Instant now) override;
  void drain() override { say_bye(ByeReason::kDraining, "the server is stopping"); }
  void abort() override;

 private:
  enum class Phase { kHello, kOpen, kClosing };

  void take(std::span<const std::byte> bytes);
  void on_inbound(const Inbound& inbound);
  void on_bytes(std::span<const std::byte> bytes);
  void on_hello(const protocol::Hello& hello);
  void refuse(RefusedReason reason, std::string_view message);
  void on_chunk(const ChunkKey& key, const ChunkResult& result);

  void refresh();
  void pump();
  bool request_next();
  void offer(const ChunkKey& key, PayloadRef payload);
  void send_chunk(const ChunkKey& key, PayloadRef payload);
  std::size_t window() const;

  OutFrame frame_of(const Message& message) const;
  void send_control(const Message& message);
  void send_bulk(const Message& message);
  void push_control(std::vector<std::byte> bytes);
  void say_bye(ByeReason reason, std::string_view message);
  void begin_closing(CloseCode code, std::string_view reason);
  void end();

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  Socket socket_;
  ConnectionPass pass_;
  std::unique_ptr<Framing> framing_;
  std::optional<std::size_t> world_;
  std::vector<std::byte> received_;

  Phase phase_ = Phase::kHello;
  bool is_ended_ = false;
  std::string id_;
  TokenBucket messages_;
  std::optional<Viewer> viewer_;
  std::unordered_map<ChunkKey, ChunkService::Ticket, ChunkKeyHash> tickets_;
  std::vector<std::pair<ChunkKey, PayloadRef>> ready_;  ///< made, and waiting for credit

  SendQueue queue_;
  std::vector<OutFrame> batch_;
  std::vector<asio::const_buffer> buffers_;
  Bell bell_;

  Instant opened_;
  Instant received_at_;
  Instant pinged_at_;
  Instant write_progress_at_;
  Instant retry_at_{};
  Instant refresh_at_{};
  Instant linger_until_ = Instant::max();
  bool is_writing_ = false;
};

StreamSession::StreamSession(NetContext& net, Sweeper& sweeper, Socket socket, ConnectionPass pass, StreamStart start)
    : Swept(sweeper),
      net_(net),
      executor_(socket.get_executor()),
      socket_(std::move(socket)),
      pass_(std::move(pass)),
      framing_(std::move(start.framing)),
      world_(start.world),
      received_(std::move(start.received)),
      messages_(net.limits.messages_per_s, net.limits.message_burst, net.clock.now()),
      bell_(executor_),
      opened_(net.clock.now()),
      received_at_(opened_),
      pinged_at_(opened_),
      write_progress_at_(opened_) {}

StreamSession::~StreamSession() {
  if (viewer_) net_.sessions.fetch_sub(1, std::memory_order_relaxed);
}

// ---- what comes in

Awaitable<void> StreamSession::read_loop() {
  take(received_);
  received_.resize(kReadBytes);
  while (!is_ended_) {
    const asio::mutable_buffer into(received_.data(), received_.size());
    const auto [error, got] = co_await socket_.async_read_some(into, kAwait);
    if (error) break;
    const Instant start = net_.clock.now();
    received_at_ = start;
    take(std::span(received_).first(got));
    net_.metrics.record(Hop::kReadLoop, net_.clock.now() - start);
  }
  end();
}

void StreamSession::take(std::span<const std::byte> bytes) {
  if (phase_ == Phase::kClosing) return;  // heard out, but not listened to
  framing_->feed(bytes);
  while (phase_ != Phase::kClosing) {
    const Instant start = net_.clock.now();
    const auto inbound = framing_->next();
    if (!inbound) break;
    net_.metrics.record(Hop::kNextMessage, net_.clock.now() - start);
    on_inbound(*inbound);
  }
  if (phase_ != Phase::kOpen) return;
  if (viewer_->is_stale() && net_.clock.now() >= refresh_at_) refresh();
  pump();
}

void StreamSession::on_inbound(const Inbound& inbound) {
  if (!messages_.take(1.0 + static_cast<double>(inbound.bytes.size()) / kMessageBytesPerToken, net_.clock.now())) {
    return say_bye(ByeReason::kTooManyMessages, "more messages than the limit allows");
  }
  switch (inbound.kind) {
    case Inbound::Kind::kMessage:
      return on_bytes(inbound.bytes);
    case Inbound::Kind::kPong:
      return;
    case Inbound::Kind::kClose:
      return begin_closing(CloseCode::kNormal, {});
    case Inbound::Kind::kPing:
      // While the peer does not read, its newest ping may go unanswered; it has others to be answered first.
      if (queue_.control_frames() < net_.limits.pongs_queued) push_control(framing_->pong(inbound.bytes));
      return;
    case Inbound::Kind::kFault:
      net_.metrics.add(Count::kByeMalformed);
      send_control(protocol::Bye{ByeReason::kMalformed, std::string(inbound.reason)});
      return begin_closing(inbound.code, inbound.reason);
  }
}

void StreamSession::on_bytes(std::span<const std::byte> bytes) {
  net_.metrics.add(Count::kMessagesReceived);
  const Instant start = net_.clock.now();
  const auto decoded = protocol::decode(bytes);
  const Instant decoded_at = net_.clock.now();
  net_.metrics.record(Hop::kDecode, decoded_at - start);
  if (!decoded) return say_bye(ByeReason::kMalformed, protocol::describe(decoded.error()));
  const Message& message = decoded->message;
  if (const auto* ping = std::get_if<protocol::Ping>(&message)) {
    if (queue_.control_frames() < net_.limits.pongs_queued) send_control(protocol::Pong{ping->nonce});
  } else if (std::holds_alternative<protocol::Pong>(message)) {
    return;
  } else if (std::holds_alternative<protocol::Bye>(message)) {
    begin_closing(CloseCode::kNormal, {});
  } else if (phase_ == Phase::kHello) {
    const auto* hello = std::get_if<protocol::Hello>(&message);
    if (hello == nullptr) return say_bye(ByeReason::kMalformed, "the first message must be hello");
    on_hello(*hello);
  } else if (!viewer_->on_message(message)) {
    say_bye(ByeReason::kMalformed, fmt::format("{} is not a client's message here", protocol::name_of(message)));
  }
  net_.metrics.record(Hop::kOnMessage, net_.clock.now() - decoded_at);
}

void StreamSession::on_hello(const protocol::Hello& hello) {
  if (hello.version_low > protocol::kVersionHigh || hello.version_high < protocol::kVersionLow) {
    return refuse(RefusedReason::kVersion, "no version in common");
  }
  const std::size_t named = hello.world.empty() && world_ ? *world_ : world_index(net_.worlds, hello.world);
  if (named == net_.worlds.size() || (world_ && *world_ != named)) {
    return refuse(RefusedReason::kWorld, "there is no world of that name here");
  }
  const bool speaks_draco = std::find(hello.formats.begin(), hello.formats.end(), "drc") != hello.formats.end();
  if (!hello.formats.empty() && !speaks_draco) return refuse(RefusedReason::kFormat, "the only format here is drc");

  const World& world = *net_.worlds[named];
  world_ = named;
  viewer_.emplace(world.shape(), hello.credit_bytes);
  phase_ = Phase::kOpen;
  const std::size_t number = net_.sessions.fetch_add(1, std::memory_order_relaxed);
  net_.metrics.add(Count::kSessionsOpened);
  id_ = fmt::format("{:016x}", mix64(static_cast<std::uint64_t>(opened_.time_since_epoch().count()), number));
  log(LogLevel::kInfo, "session opened", {{"session", id_}, {"world", world.name()}, {"client", hello.client}});
  send_control(protocol::Welcome{std::min(hello.version_high, protocol::kVersionHigh), id_, world.hash(), "drc",
                                 world.manifest_json()});
}

void StreamSession::refuse(RefusedReason reason, std::string_view message) {
  net_.metrics.add(Count::kSessionsRefused);
  std::vector<std::uint16_t> versions;
  for (std::uint16_t v = protocol::kVersionLow; v <= protocol::kVersionHigh; ++v) versions.push_back(v);
  send_control(protocol::Refused{reason, std::string(message), std::move(versions)});
  begin_closing(CloseCode::kPolicy, message);
}

// ---- what goes out

void StreamSession::refresh() {
  const Instant start = net_.clock.now();
  const Viewer::Change change = viewer_->refresh();
  for (const ChunkKey& key : change.cancelled) {
    tickets_.erase(key);
    std::erase_if(ready_, [&](const auto& ready) { return ready.first == key; });
  }
  for (const WantedChunk& chunk : change.moved) {
    if (const auto found = tickets_.find(chunk.key); found != tickets_.end()) found->second.set_urgency(chunk.urgency);
  }
  if (change.accepted) send_control(*change.accepted);
  // Behind the chunks that are queued already: a chunk must not come after its own leave.
  for (std::size_t i = 0; i < change.leave.size(); i += protocol::kKeysPerMessageMax) {
    const std::size_t count = std::min(protocol::kKeysPerMessageMax, change.leave.size() - i);
    const auto first = change.leave.begin() + static_cast<std::ptrdiff_t>(i);
    send_bulk(protocol::Leave{{first, first + static_cast<std::ptrdiff_t>(count)}});
  }
  const Instant now = net_.clock.now();
  const auto cost = std::chrono::duration_cast<Duration>((now - start) * kRefreshShare);
  refresh_at_ = now + std::max(seconds(kRefreshS), cost);
}

std::size_t StreamSession::window() const {
  const std::size_t sessions = std::max<std::size_t>(1, net_.sessions.load(std::memory_order_relaxed));
  return std::clamp(kWindowsSum / sessions, kWindowMin, std::max(kWindowMin, net_.limits.window_max));
}

void StreamSession::pump() {
  if (phase_ != Phase::kOpen) return;
  while (!ready_.empty()) {
    auto& [key, payload] = ready_.front();
    if (viewer_->deliver(key, payload->bytes.size()) == Viewer::Delivery::kNoCredit) break;
    send_chunk(key, std::move(payload));
    ready_.erase(ready_.begin());
  }
  const Instant now = net_.clock.now();
  while (ready_.empty() && phase_ == Phase::kOpen && now >= retry_at_ && viewer_->in_flight() < window() &&
         queue_.bytes() < kPumpBelowBytes) {
    if (!request_next()) break;
  }
  if (const auto idle = viewer_->take_idle()) send_bulk(*idle);
}

/// False when there is nothing to request, or no place for it now.
bool StreamSession::request_next() {
  const auto next = viewer_->next_request();
  if (!next) return false;
  ChunkService::Done done = [self = shared_from_this(), key = next->key](ChunkResult result) mutable {
    StreamSession& session = *self;
    asio::post(session.executor_,
               [self = std::move(self), key, result = std::move(result)] { self->on_chunk(key, result); });
  };
  PayloadName name;
  name.world = static_cast<std::uint32_t>(*world_);
  name.key = next->key;
  ChunkService::Answer answer = net_.chunks.request(name, Lane::kStream, next->urgency, std::move(done));
  if (auto* payload = std::get_if<PayloadRef>(&answer)) {
    offer(next->key, std::move(*payload));
  } else if (auto* ticket = std::get_if<ChunkService::Ticket>(&answer)) {
    tickets_[next->key] = std::move(*ticket);
  } else {
    viewer_->put_back(next->key);
    retry_at_ = net_.clock.now() + seconds(kRetryS);
    return false;
  }
  return true;
}

void StreamSession::on_chunk(const ChunkKey& key, const ChunkResult& result) {
  if (phase_ != Phase::kOpen || tickets_.erase(key) == 0) return;
  if (result) {
    offer(key, *result);
  } else {
    // It would fail again: the place stays as it is at the client, and the view can still become complete.
    viewer_->deliver(key, 0);
  }
  pump();
}

void StreamSession::offer(const ChunkKey& key, PayloadRef payload) {
  if (queue_.bytes() > net_.limits.send_soft_bytes) {
    net_.metrics.add(Count::kSendShed);
    return viewer_->put_back(key);
  }
  switch (viewer_->deliver(key, payload->bytes.size())) {
    case Viewer::Delivery::kSend:
      return send_chunk(key, std::move(payload));
    case Viewer::Delivery::kUnwanted:
      return;
    case Viewer::Delivery::kNoCredit:
      if (ready_.empty()) net_.metrics.add(Count::kCreditWaits);
      ready_.emplace_back(key, std::move(payload));
      return;
  }
}

void StreamSession::send_chunk(const ChunkKey& key, PayloadRef payload) {
  const auto bytes = static_cast<std::uint32_t>(payload->bytes.size());
  OutFrame frame;
  frame.message = protocol::encode(protocol::ChunkHead{key, 0, payload->kind, bytes});
  frame.head = framing_->message_head(frame.message.size() + bytes);
  if (bytes != 0) frame.payload = std::move(payload);
  net_.metrics.add(Count::kChunksSent);
  net_.metrics.add(Count::kChunkBytesSent, frame.message.size() + bytes);
  queue_.push_bulk(std::move(frame));
  bell_.ring();
}

OutFrame StreamSession::frame_of(const Message& message) const {
  OutFrame frame;
  frame.message = protocol::encode(message);
  frame.head = framing_->message_head(frame.message.size());
  return frame;
}

void StreamSession::send_control(const Message& message) {
  queue_.push_control(frame_of(message));
  bell_.ring();
}

void StreamSession::send_bulk(const Message& message) {
  queue_.push_bulk(frame_of(message));
  bell_.ring();
}

void StreamSession::push_control(std::vector<std::byte> bytes) {
  if (bytes.empty()) return;
  OutFrame frame;
  frame.message = std::move(bytes);
  queue_.push_control(std::move(frame));
  bell_.ring();
}

Awaitable<void> StreamSession::write_loop() {
  while (!is_ended_) {
    if (queue_.empty()) {
      if (phase_ == Phase::kClosing) break;
      co_await bell_.wait();
      continue;
    }
    const Instant start = net_.clock.now();
    queue_.pop_batch(kBatchFrames, kBatchBytes, batch_);
    buffers_.clear();
    for (const OutFrame& frame : batch_) {
      buffers_.emplace_back(frame.head.bytes.data(), frame.head.size);
      buffers_.push_back(asio::buffer(frame.message));
      if (frame.payload != nullptr) buffers_.push_back(asio::buffer(frame.payload->bytes));
    }
    is_writing_ = true;
    write_progress_at_ = start;
    std::span<asio::const_buffer> left(buffers_);
    while (!left.empty()) {
      asio::error_code error;
      std::size_t sent = socket_.write_some(left, error);
      if (error && error != asio::error::would_block) co_return end();
      if (sent != 0) write_progress_at_ = net_.clock.now();
      while (!left.empty() && sent >= left.front().size()) {
        sent -= left.front().size();
        left = left.subspan(1);
      }
      if (left.empty()) break;
      left.front() += sent;
      const auto [wait_error] = co_await socket_.async_wait(Socket::wait_write, kAwait);
      if (wait_error) co_return end();
    }
    is_writing_ = false;
    batch_.clear();
    net_.metrics.record(Hop::kWriteLoop, net_.clock.now() - start);
    pump();
  }
  asio::error_code ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
}

// ---- the end

void StreamSession::say_bye(ByeReason reason, std::string_view message) {
  if (phase_ == Phase::kClosing) return;
  net_.metrics.add(count_of(reason));
  log(LogLevel::kInfo, "session ended by the server",
      {{"session", id_}, {"reason", protocol::name_of(reason)}, {"message", message}});
  send_control(protocol::Bye{reason, std::string(message)});
  begin_closing(close_code(reason), message);
}

void StreamSession::begin_closing(CloseCode code, std::string_view reason) {
  if (phase_ == Phase::kClosing) return;
  push_control(framing_->close(code, reason));
  phase_ = Phase::kClosing;
  tickets_.clear();
  ready_.clear();
  queue_.drop_bulk();
  linger_until_ = net_.clock.now() + seconds(kLingerS);
  bell_.ring();
}

void StreamSession::end() {
  if (std::exchange(is_ended_, true)) return;
  phase_ = Phase::kClosing;
  tickets_.clear();
  ready_.clear();
  close_socket(socket_);
  bell_.ring();
}

void StreamSession::abort() {
  reset_socket(socket_);
  end();
}

void StreamSession::sweep(Instant now) {
  const NetLimits& limits = net_.limits;
  if (is_writing_ && now - write_progress_at_ > seconds(limits.write_stall_s)) {
    net_.metrics.add(Count::kByeTooSlow);
    net_.metrics.add(Count::kWriteStalled);
    return abort();
  }
  if (queue_.bytes() > limits.send_hard_bytes) {
    net_.metrics.add(Count::kSendOverflow);
    return abort();
  }
  if (phase_ == Phase::kClosing) {
    if (now >= linger_until_) end();
    return;
  }
  if (phase_ == Phase::kHello && now - opened_ > seconds(limits.silent_s)) {
    return say_bye(ByeReason::kSilent, "no hello came");
  }
  if (now - received_at_ > seconds(limits.gone_s)) {
    net_.metrics.add(Count::kByeSilent);
    return abort();
  }
  if (now - std::max(received_at_, pinged_at_) > seconds(limits.ping_s)) {
    pinged_at_ = now;
    std::vector<std::byte> ping = framing_->ping();
    ping.empty() ? send_control(protocol::Ping{0}) : push_control(std::move(ping));
  }
  if (phase_ != Phase::kOpen) return;
  if (viewer_->is_stale() && now >= refresh_at_) refresh();
  pump();
}

}  // namespace

void start_stream_session(NetContext& net, Sweeper& sweeper, Socket socket, ConnectionPass pass, StreamStart start) {
  const auto executor = socket.get_executor();
  const auto session =
      std::make_shared<StreamSession>(net, sweeper, std::move(socket), std::move(pass), std::move(start));
  const auto ended = [session, &net](const std::exception_ptr& fault) {
    if (fault == nullptr) return;
    net.metrics.add(Count::kConnectionFault);
    session->abort();
  };
  asio::co_spawn(executor, session->read_loop(), ended);
  asio::co_spawn(executor, session->write_loop(), ended);
}

}  // namespace talus::server
