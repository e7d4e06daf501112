#include "server/net/stream_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "core/base/hash.hpp"
#include "protocol/limits.hpp"
#include "protocol/message.hpp"
#include "server/net/chunk_feed.hpp"
#include "server/net/frame_writer.hpp"
#include "server/net/request_id.hpp"
#include "server/net/token_bucket.hpp"
#include "server/observe/log.hpp"

namespace talus::server {

namespace {

using protocol::ByeReason;
using protocol::Message;
using protocol::RefusedReason;

/// What is read at once: several of a viewer's messages. Each session keeps so much for as long as it lasts, so a
/// longer message is put together from several reads.
constexpr std::size_t kStreamReadBytes = 1024;
constexpr double kByeLingerS = 2;
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
  StreamSession(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                StreamStart start);

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

  void say_bye(ByeReason reason, std::string_view message);
  void cut(ByeReason reason, std::string_view limit);
  void begin_closing(CloseCode code, std::string_view reason);
  void end();

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  const std::unique_ptr<Channel> channel_;
  ConnectionPass pass_;
  std::unique_ptr<Framing> framing_;
  std::optional<std::size_t> world_;
  std::vector<std::byte> received_;  ///< behind the handshake, until the first read
  std::array<std::byte, kStreamReadBytes> inbox_;
  const bool is_admitted_;

  Phase phase_ = Phase::kHello;
  bool is_ended_ = false;
  std::string id_;
  const std::string request_id_;
  const NetLimits& limits_;
  TokenBucket messages_;

  FrameWriter writer_;
  std::optional<ChunkFeed> feed_;  ///< from hello to the end

  Instant opened_;
  Instant received_at_;
  Instant pinged_at_;
  Instant partial_since_ = Instant::max();  ///< when the message under way began
  Instant linger_until_ = Instant::max();
};

StreamSession::StreamSession(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                             StreamStart start)
    : Swept(sweeper),
      net_(net),
      executor_(channel->executor()),
      channel_(std::move(channel)),
      pass_(std::move(pass)),
      framing_(std::move(start.framing)),
      world_(start.world),
      received_(std::move(start.received)),
      is_admitted_(start.is_admitted),
      request_id_(std::move(start.request_id)),
      limits_(pass_.policy->limits),
      messages_(limits_.messages_per_s, limits_.message_burst, net.clock.now()),
      writer_(net, *channel_, *framing_),
      opened_(net.clock.now()),
      received_at_(opened_),
      pinged_at_(opened_) {}

// ---- what comes in

Awaitable<void> StreamSession::read_loop() {
  take(received_);
  received_ = std::vector<std::byte>();
  while (!is_ended_) {
    const auto [error, got] = co_await channel_->read_some(inbox_);
    if (error) break;
    const Instant start = net_.clock.now();
    received_at_ = start;
    take(std::span(inbox_).first(got));
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
    // A ping between the parts of a message does not begin the message anew.
    if (inbound->kind == Inbound::Kind::kMessage || framing_->is_between_messages()) partial_since_ = Instant::max();
    on_inbound(*inbound);
  }
  if (!framing_->is_between_messages()) partial_since_ = std::min(partial_since_, received_at_);
  if (phase_ != Phase::kOpen) return;
  feed_->advance();
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
      if (writer_.control_frames() < limits_.pongs_queued) writer_.push_control(framing_->pong(inbound.bytes));
      return;
    case Inbound::Kind::kFault:
      net_.metrics.add(Count::kByeMalformed);
      writer_.send_control(protocol::Bye{ByeReason::kMalformed, std::string(inbound.reason)});
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
    if (writer_.control_frames() < limits_.pongs_queued) writer_.send_control(protocol::Pong{ping->nonce});
  } else if (std::holds_alternative<protocol::Pong>(message)) {
    return;
  } else if (std::holds_alternative<protocol::Bye>(message)) {
    begin_closing(CloseCode::kNormal, {});
  } else if (phase_ == Phase::kHello) {
    const auto* hello = std::get_if<protocol::Hello>(&message);
    if (hello == nullptr) return say_bye(ByeReason::kMalformed, "the first message must be hello");
    on_hello(*hello);
  } else if (!feed_->on_message(message)) {
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
  const MeshFormat* format = hello.formats.empty() ? kMeshFormats.data() : nullptr;
  for (const std::string& offered : hello.formats) {
    format = mesh_format_named(offered);
    if (format != nullptr) break;
  }
  if (format == nullptr) return refuse(RefusedReason::kFormat, "the formats here are drc and mesh");

  const World& world = *net_.worlds[named];
  if (!is_admitted_) {
    const PolicyRef present = net_.policy.load();
    if (const auto fault = present->tokens.fault_of(hello.token, world.name(), net_.clock.unix_seconds())) {
      net_.metrics.add(server::count_of(*fault));
      return refuse(RefusedReason::kToken, describe(*fault));
    }
  }
  world_ = named;
  const std::uint16_t version = std::min(hello.version_high, protocol::kVersionHigh);
  const std::uint64_t number = net_.session_numbers.fetch_add(1, std::memory_order_relaxed);
  const ClientId client = 2 * (number + 1);  // even: addresses have odd ones
  feed_.emplace(net_, limits_, writer_, named, *format, hello.credit_bytes, version, client, executor_,
                weak_from_this());
  phase_ = Phase::kOpen;
  net_.metrics.add(Count::kSessionsOpened);
  const auto digits = hex_digits(mix64(static_cast<std::uint64_t>(opened_.time_since_epoch().count()), number));
  id_.assign(digits.data(), digits.size());
  log(LogLevel::kInfo, "session opened",
      {{"request", request_id_}, {"session", id_}, {"world", world.name()}, {"client", hello.client}});
  writer_.send_control(protocol::Welcome{version, id_, world.hash(), std::string(format->name), world.manifest_json()});
}

void StreamSession::refuse(RefusedReason reason, std::string_view message) {
  net_.metrics.add(Count::kSessionsRefused);
  std::vector<std::uint16_t> versions;
  for (std::uint16_t v = protocol::kVersionLow; v <= protocol::kVersionHigh; ++v) versions.push_back(v);
  writer_.send_control(protocol::Refused{reason, std::string(message), std::move(versions)});
  begin_closing(CloseCode::kPolicy, message);
}

Awaitable<void> StreamSession::write_loop() {
  while (!is_ended_) {
    if (!writer_.empty()) {
      const bool was_written = co_await writer_.write_batch();
      if (!was_written) end();
      if (feed_) feed_->advance();
    } else if (phase_ != Phase::kClosing) {
      co_await writer_.wait();
    } else {
      break;
    }
  }
  channel_->shutdown_send();
}

// ---- the end

void StreamSession::say_bye(ByeReason reason, std::string_view message) {
  if (phase_ == Phase::kClosing) return;
  net_.metrics.add(count_of(reason));
  log(LogLevel::kInfo, "session ended by the server",
      {{"request", request_id_}, {"session", id_}, {"reason", protocol::name_of(reason)}, {"message", message}});
  writer_.send_control(protocol::Bye{reason, std::string(message)});
  begin_closing(close_code(reason), message);
}

void StreamSession::begin_closing(CloseCode code, std::string_view reason) {
  if (phase_ == Phase::kClosing) return;
  writer_.push_control(framing_->close(code, reason));
  phase_ = Phase::kClosing;
  if (feed_) feed_->close();
  writer_.drop_bulk();
  linger_until_ = net_.clock.now() + seconds(kByeLingerS);
  writer_.ring();
}

void StreamSession::end() {
  if (std::exchange(is_ended_, true)) return;
  phase_ = Phase::kClosing;
  if (feed_) feed_->close();
  channel_->close();
  writer_.ring();
}

/// Ends who would not hear a goodbye any more.
void StreamSession::cut(ByeReason reason, std::string_view limit) {
  net_.metrics.add(count_of(reason));
  log(LogLevel::kInfo, "session cut off",
      {{"request", request_id_}, {"session", id_}, {"reason", protocol::name_of(reason)}, {"limit", limit}});
  abort();
}

void StreamSession::abort() {
  channel_->reset();
  end();
}

void StreamSession::sweep(Instant now) {
  if (const auto pace = writer_.judge_pace(now, limits_); pace != ReadPace::Verdict::kFine) {
    net_.metrics.add(server::count_of(pace));
    return cut(ByeReason::kTooSlow, pace == ReadPace::Verdict::kStalled ? "write_stall_s" : "read_rate_min");
  }
  if (writer_.bytes() > limits_.send_hard_bytes) {
    net_.metrics.add(Count::kSendOverflow);
    return cut(ByeReason::kTooSlow, "send_hard_bytes");
  }
  if (phase_ == Phase::kClosing) {
    if (now >= linger_until_) end();
    return;
  }
  if (phase_ == Phase::kHello && now - opened_ > seconds(limits_.silent_s)) {
    return say_bye(ByeReason::kSilent, "no hello came");
  }
  if (partial_since_ < now - seconds(limits_.message_s)) {
    net_.metrics.add(Count::kMessageTimeout);
    return say_bye(ByeReason::kTooSlow, "message_s: a message took too long to come");
  }
  if (now - received_at_ > seconds(limits_.gone_s)) {
    return cut(ByeReason::kSilent, "gone_s");
  }
  if (now - std::max(received_at_, pinged_at_) > seconds(limits_.ping_s)) {
    pinged_at_ = now;
    std::vector<std::byte> ping = framing_->ping();
    ping.empty() ? writer_.send_control(protocol::Ping{0}) : writer_.push_control(std::move(ping));
  }
  if (phase_ == Phase::kOpen) feed_->advance();
}

}  // namespace

void start_stream_session(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                          StreamStart start) {
  const auto executor = channel->executor();
  const auto session =
      std::make_shared<StreamSession>(net, sweeper, std::move(channel), std::move(pass), std::move(start));
  const auto ended = [session, &net](const std::exception_ptr& fault) {
    if (fault == nullptr) return;
    net.metrics.add(Count::kConnectionFault);
    session->abort();
  };
  asio::co_spawn(executor, session->read_loop(), ended);
  asio::co_spawn(executor, session->write_loop(), ended);
}

}  // namespace talus::server
