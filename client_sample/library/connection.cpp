#include "client_sample/library/connection.hpp"

#include <array>
#include <deque>
#include <random>
#include <utility>
#include <variant>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>

#include "client_sample/library/client_socket.hpp"
#include "client_sample/library/handshake.hpp"
#include "client_sample/library/length_frames.hpp"
#include "client_sample/library/websocket_frames.hpp"
#include "protocol/limits.hpp"

namespace talus::client {

using asio::ip::tcp;
using Bytes = std::vector<std::byte>;

Loop::Loop() : context_(std::make_unique<asio::io_context>(1)) {}
Loop::~Loop() = default;

void Loop::poll() {
  context_->restart();
  context_->poll();
}

void Loop::run_for(std::chrono::milliseconds time) {
  context_->restart();
  context_->run_for(time);
}

/// Every pending operation holds a reference; `is_over_` makes the late ones do nothing.
class Connection::State : public std::enable_shared_from_this<State> {
 public:
  State(asio::io_context& context, ServerAddress server, std::string target, Handlers handlers)
      : server_(std::move(server)),
        resolver_(context),
        socket_(context, server_),
        deadline_(context),
        target_(std::move(target)),
        handlers_(std::move(handlers)),
        random_(std::random_device{}()) {
    if (is_tcp()) reader_.emplace<LengthReader>(protocol::kOutboundMessageBytesMax);
  }

  void open() {
    expire_in(kOpenTimeout);
    resolver_.async_resolve(
        server_.host, std::to_string(server_.port),
        [self = shared_from_this()](const asio::error_code& error, const tcp::resolver::results_type& found) {
          if (self->is_over_) return;
          if (error) return self->end({ErrorCode::kResolve, "no address for " + self->server_.host});
          self->connect(found);
        });
  }

  void send(Opcode opcode, std::span<const std::byte> payload) {
    if (!is_open_ || is_over_) return;
    outbox_.push_back(is_tcp() ? length_frame(payload)
                               : masked_frame(opcode, payload, static_cast<std::uint32_t>(random_())));
    if (outbox_.size() == 1) write();
  }

  void close() {
    if (is_over_) return;
    if (!is_open_) return end({ErrorCode::kConnect, "closed before the connection was open"});
    if (is_closing_) return;
    is_closing_ = true;
    if (is_tcp()) {
      end_sending();
    } else {
      const std::array<std::byte, 2> normal{std::byte{0x03}, std::byte{0xE8}};  // 1000
      send(Opcode::kClose, normal);
    }
    expire_in(std::chrono::seconds(2));
  }

  void stall() {
    if (is_over_ || is_stalled_) return;
    is_stalled_ = true;
    deadline_.cancel();
    socket_.async_wait_cut([self = shared_from_this()](const asio::error_code&) {
      if (!self->is_over_) self->end({ErrorCode::kConnect, "the server cut the connection that did not read"});
    });
  }

  /// The last step: every way the connection can end comes by here once. By value: what abandon() lets go of may own
  /// the caller's.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  void end(ClientError error) {
    if (is_over_) return;
    const Handlers handlers = std::move(handlers_);
    abandon();
    if (handlers.on_closed) handlers.on_closed(error);
  }

  void abandon() {
    is_over_ = true;
    handlers_ = {};
    resolver_.cancel();
    deadline_.cancel();
    socket_.close();
  }

 private:
  bool is_tcp() const { return server_.carrier == Carrier::kTcp; }

  /// On plain TCP the end of what we say is the end of our half of the stream.
  void end_sending() {
    if (!outbox_.empty()) return;
    socket_.end_sending();
  }

  void connect(const tcp::resolver::results_type& found) {
    socket_.async_open(found, [self = shared_from_this()](const asio::error_code& error) {
      if (self->is_over_) return;
      if (error) {
        return self->end(
            {ErrorCode::kConnect, "no connection to " + self->server_.authority() + " (" + error.message() + ")"});
      }
      self->socket_.set_no_delay();
      self->is_tcp() ? self->begin() : self->shake_hands();
    });
  }

  /// Messages may come and go.
  void begin() {
    is_open_ = true;
    expire_in(kSilenceMax);
    if (handlers_.on_open) handlers_.on_open();
    if (!is_over_ && is_tcp()) read();
  }

  void shake_hands() {
    key_ = handshake_key(random_(), random_());
    request_ = handshake_request(server_, target_, key_);
    asio::async_write(socket_, asio::buffer(request_),
                      [self = shared_from_this()](const asio::error_code& error, std::size_t) {
                        if (self->is_over_) return;
                        if (error) return self->end({ErrorCode::kConnect, "the connection broke: " + error.message()});
                        self->read();
                      });
  }

  void read() {
    socket_.async_read_some(asio::buffer(input_),
                            [self = shared_from_this()](const asio::error_code& error, std::size_t size) {
                              if (self->is_over_ || self->is_stalled_) return;
                              if (error) return self->end(self->broken(error));
                              const std::span<const std::byte> bytes = std::span(self->input_).first(size);
                              self->is_open_ ? self->take(bytes) : self->take_handshake(bytes);
                              if (!self->is_over_ && !self->is_stalled_) self->read();
                            });
  }

  ClientError broken(const asio::error_code& error) const {
    if (is_closing_) return {ErrorCode::kBye, "closed as asked"};
    return {ErrorCode::kConnect, "the connection broke: " + error.message()};
  }

  void take_handshake(std::span<const std::byte> bytes) {
    answer_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t end_of_head = answer_.find("\r\n\r\n");
    if (end_of_head == std::string::npos) {
      if (answer_.size() > kHandshakeBytesMax) end({ErrorCode::kHandshake, "the server's answer does not end"});
      return;
    }
    if (const auto error = handshake_fault(answer_, key_)) return end(*error);
    const Bytes rest = [&] {
      const auto view = std::as_bytes(std::span(answer_)).subspan(end_of_head + 4);
      return Bytes(view.begin(), view.end());
    }();
    answer_.clear();
    begin();
    if (!is_over_ && !rest.empty()) take(rest);
  }

  void take(std::span<const std::byte> bytes) {
    if (!is_closing_) expire_in(kSilenceMax);
    std::visit([&](auto& reader) { reader.feed(bytes); }, reader_);
    while (!is_over_) {
      const auto event = std::visit([](auto& reader) { return reader.next(); }, reader_);
      if (!event) return;
      switch (event->kind) {
        case FrameReader::Event::Kind::kMessage:
          if (handlers_.on_message) handlers_.on_message(event->bytes);
          break;
        case FrameReader::Event::Kind::kPing:
          send(Opcode::kPong, event->bytes);
          break;
        case FrameReader::Event::Kind::kPong:
          break;
        case FrameReader::Event::Kind::kClose:
          return end({ErrorCode::kBye,
                      is_closing_ ? "closed as asked"
                                  : "the server closed the connection, code " + std::to_string(event->close_code)});
        case FrameReader::Event::Kind::kFault:
          return end({ErrorCode::kProtocol, "the server broke the framing: " + std::string(event->fault)});
      }
    }
  }

  void write() {
    asio::async_write(socket_, asio::buffer(outbox_.front()),
                      [self = shared_from_this()](const asio::error_code& error, std::size_t) {
                        if (self->is_over_) return;
                        if (error) return self->end(self->broken(error));
                        self->outbox_.pop_front();
                        if (!self->outbox_.empty()) return self->write();
                        if (self->is_closing_ && self->is_tcp()) self->end_sending();
                      });
  }

  void expire_in(std::chrono::seconds time) {
    deadline_.expires_after(time);
    deadline_.async_wait([self = shared_from_this()](const asio::error_code& error) {
      if (error || self->is_over_) return;
      if (self->is_closing_) return self->end({ErrorCode::kBye, "closed as asked"});
      self->end({ErrorCode::kTimeout, self->server_.authority() + " does not answer"});
    });
  }

  const ServerAddress server_;
  tcp::resolver resolver_;
  ClientSocket socket_;
  asio::steady_timer deadline_;
  const std::string target_;
  Handlers handlers_;
  std::mt19937_64
      random_;  ///< masks keep proxies from reading our bytes as theirs; nobody has to be kept from guessing
  std::string key_;
  std::string request_;
  std::string answer_;
  std::variant<FrameReader, LengthReader> reader_{FrameReader(protocol::kOutboundMessageBytesMax)};
  std::array<std::byte, 16 * 1024> input_{};  ///< a chunk or two; programs with many connections pay it for each
  std::deque<Bytes> outbox_;
  bool is_open_ = false;
  bool is_closing_ = false;
  bool is_over_ = false;
  bool is_stalled_ = false;
};

Connection::Connection(Loop& loop, const ServerAddress& server, std::string target, Handlers handlers)
    : state_(std::make_shared<State>(loop.context(), server, std::move(target), std::move(handlers))) {
  state_->open();
}

Connection::~Connection() {
  state_->abandon();
}

void Connection::send(std::vector<std::byte> message) {
  state_->send(Opcode::kBinary, message);
}

void Connection::close() {
  state_->close();
}

void Connection::stall() {
  state_->stall();
}

}  // namespace talus::client
