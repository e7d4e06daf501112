#include "client_sample/library/world_stream.hpp"

#include <algorithm>
#include <utility>

#include "protocol/limits.hpp"

namespace talus::client {

using protocol::Message;

class WorldStream::Viewer {
 public:
  Viewer(Loop& loop, StreamOptions options, StreamHandlers handlers)
      : options_(std::move(options)),
        handlers_(std::move(handlers)),
        connection_(loop, options_.server, "/v1/worlds/" + options_.world + "/stream", connection_handlers()) {}

  std::uint32_t look(const protocol::View& view) {
    protocol::ViewMessage message{++sequence_, view};
    if (info_) {
      send(message);
    } else {
      waiting_view_ = message;
    }
    return sequence_;
  }

  void want(std::vector<protocol::HeldChunk> chunks, std::vector<StripKey> strips) {
    chunks.resize(std::min(chunks.size(), protocol::kKeysPerMessageMax));
    strips.resize(std::min(strips.size(), protocol::kKeysPerMessageMax - chunks.size()));
    protocol::Want message{std::move(chunks), std::move(strips)};
    if (info_) {
      send(message);
    } else {
      waiting_want_ = std::move(message);
    }
  }

  void give_credit(std::uint64_t bytes) {
    owed_bytes_ += bytes;
    // One message for every eighth of the credit: the server never waits for it, and it costs little.
    if (info_ && owed_bytes_ >= options_.credit_bytes / 8) pay_credit();
  }

  void close() {
    send(protocol::Bye{protocol::ByeReason::kLeaving, ""});
    connection_.close();
  }

  void stall() { connection_.stall(); }

  const std::optional<WorldInfo>& info() const { return info_; }

 private:
  Connection::Handlers connection_handlers() {
    return {[this] { greet(); }, [this](std::span<const std::byte> bytes) { take(bytes); },
            [this](const ClientError& error) { end(error); }};
  }

  void send(const Message& message) { connection_.send(protocol::encode(message)); }

  void pay_credit() {
    if (owed_bytes_ != 0) send(protocol::Credit{std::exchange(owed_bytes_, 0)});
  }

  void greet() {
    send(protocol::Hello{protocol::kVersionLow, protocol::kVersionHigh, options_.world, options_.server.token,
                         options_.formats, options_.credit_bytes, options_.client});
  }

  void take(std::span<const std::byte> bytes) {
    auto decoded = protocol::decode(bytes);
    if (!decoded) {
      return break_off("a message of the server: " + std::string(describe(decoded.error())));
    }
    const Message& message = decoded->message;
    if (const auto* chunk = std::get_if<protocol::ChunkHead>(&message)) {
      if (!info_) return break_off("a chunk came before the welcome");
      if (handlers_.on_chunk) handlers_.on_chunk({*chunk, decoded->payload, bytes.size()});
      if (!options_.gives_credit_itself) give_credit(bytes.size());
    } else if (const auto* strip = std::get_if<protocol::StripHead>(&message)) {
      if (!info_) return break_off("a strip came before the welcome");
      if (strip->strip.key.lod == 0) return break_off("a strip of LOD 0, which nothing is finer than");
      if (handlers_.on_strip) handlers_.on_strip({*strip, decoded->payload, bytes.size()});
      if (!options_.gives_credit_itself) give_credit(bytes.size());
    } else if (const auto* failed = std::get_if<protocol::Failed>(&message)) {
      if (!info_) return break_off("a failure came before the welcome");
      if (handlers_.on_failed) handlers_.on_failed(*failed);
    } else if (const auto* leave = std::get_if<protocol::Leave>(&message)) {
      if (handlers_.on_leave) handlers_.on_leave(leave->keys);
    } else if (const auto* accepted = std::get_if<protocol::ViewAccepted>(&message)) {
      if (handlers_.on_view) handlers_.on_view(*accepted);
    } else if (const auto* idle = std::get_if<protocol::Idle>(&message)) {
      if (handlers_.on_idle) handlers_.on_idle(*idle);
    } else if (const auto* ping = std::get_if<protocol::Ping>(&message)) {
      send(protocol::Pong{ping->nonce});
    } else if (const auto* welcome = std::get_if<protocol::Welcome>(&message)) {
      begin(*welcome);
    } else if (const auto* refused = std::get_if<protocol::Refused>(&message)) {
      fail({ErrorCode::kRefused,
            "the server refused (" + std::string(name_of(refused->reason)) + "): " + refused->message,
            refused->reason == protocol::RefusedReason::kBusy});
    } else if (const auto* bye = std::get_if<protocol::Bye>(&message)) {
      const std::string text = bye->message.empty() ? "" : ": " + bye->message;
      fail({ErrorCode::kBye, "the server said goodbye (" + std::string(name_of(bye->reason)) + ")" + text,
            bye->reason != protocol::ByeReason::kMalformed});
    }
  }

  void begin(const protocol::Welcome& welcome) {
    if (info_) return break_off("a second welcome");
    if (welcome.version < protocol::kVersionLow || welcome.version > protocol::kVersionHigh) {
      return break_off("the server welcomed a version that was not offered");
    }
    info_ = parse_world_info(welcome.manifest_json);
    if (!info_) return break_off("the manifest of the welcome cannot be read");
    if (options_.held_world_hash.empty() || options_.held_world_hash == info_->world_hash) say_what_is_held();
    if (waiting_view_) send(*std::exchange(waiting_view_, std::nullopt));
    if (waiting_want_) send(*std::exchange(waiting_want_, std::nullopt));
    // What was consumed behind the hello: the server may have been promised so little that nothing would ever come
    // which could bring the next eighth together.
    pay_credit();
    if (handlers_.on_welcome) handlers_.on_welcome(*info_);
  }

  void say_what_is_held() {
    const auto part = [](const auto& all, std::size_t at) {
      const std::size_t first = std::min(at, all.size());
      const std::size_t last = std::min(at + protocol::kKeysPerMessageMax, all.size());
      return std::decay_t<decltype(all)>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                         all.begin() + static_cast<std::ptrdiff_t>(last));
    };
    for (std::size_t at = 0; at < options_.held.size(); at += protocol::kKeysPerMessageMax) {
      send(protocol::Held{part(options_.held, at), part(options_.held_faces, at), {}});
    }
    for (std::size_t at = 0; at < options_.held_strips.size(); at += protocol::kKeysPerMessageMax) {
      send(protocol::Held{{}, {}, part(options_.held_strips, at)});
    }
  }

  /// The server broke the protocol, and would again.
  void break_off(std::string what) { fail({ErrorCode::kProtocol, std::move(what), false}); }

  /// Ends the session for a reason of the protocol; the reason is what on_closed says.
  void fail(ClientError error) {
    if (!reason_) reason_ = std::move(error);
    connection_.close();
  }

  void end(const ClientError& error) {
    if (handlers_.on_closed) handlers_.on_closed(reason_ ? *reason_ : error);
  }

  StreamOptions options_;
  StreamHandlers handlers_;
  std::optional<WorldInfo> info_;
  std::optional<protocol::ViewMessage> waiting_view_;
  std::optional<protocol::Want> waiting_want_;
  std::optional<ClientError> reason_;
  std::uint32_t sequence_ = 0;
  std::uint64_t owed_bytes_ = 0;
  Connection connection_;  ///< last: its handlers use all of the above
};

WorldStream::WorldStream(Loop& loop, StreamOptions options, StreamHandlers handlers)
    : viewer_(std::make_unique<Viewer>(loop, std::move(options), std::move(handlers))) {}
WorldStream::~WorldStream() = default;

std::uint32_t WorldStream::look(const protocol::View& view) {
  return viewer_->look(view);
}
void WorldStream::want(std::vector<protocol::HeldChunk> chunks, std::vector<StripKey> strips) {
  viewer_->want(std::move(chunks), std::move(strips));
}
void WorldStream::give_credit(std::uint64_t bytes) {
  viewer_->give_credit(bytes);
}
void WorldStream::close() {
  viewer_->close();
}
void WorldStream::stall() {
  viewer_->stall();
}
const std::optional<WorldInfo>& WorldStream::info() const {
  return viewer_->info();
}

}  // namespace talus::client
