#include "client_sample/library/http_client.hpp"

#include <array>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>

#include "client_sample/library/client_socket.hpp"
#include "core/base/check.hpp"

namespace talus::client {

using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

/// Every pending operation holds a reference, and the number of the exchange it belongs to: those of an exchange that
/// is over do nothing.
class HttpClient::State : public std::enable_shared_from_this<State> {
 public:
  State(asio::io_context& context, ServerAddress server)
      : server_(std::move(server)), resolver_(context), socket_(context, server_), deadline_(context) {}

  void get(const std::string& target, Done done) {
    TALUS_CHECK(!done_);
    done_ = std::move(done);
    request_ = "GET " + server_.prefix + target + " HTTP/1.1\r\nHost: " + server_.authority() +
               "\r\nUser-Agent: talus\r\nAccept: */*\r\n" + server_.authorization() + "\r\n";
    is_fresh_ = !is_connected_;
    expire();
    is_connected_ ? write() : resolve();
  }

  bool is_waiting() const { return static_cast<bool>(done_); }

  void abandon() {
    ++exchange_;
    done_ = {};
    disconnect();
  }

 private:
  void disconnect() {
    is_connected_ = false;
    resolver_.cancel();
    deadline_.cancel();
    socket_.close();
    reader_ = std::make_unique<HttpReader>();
  }

  /// Wraps a completion so that it is dropped once the exchange it belongs to is over.
  template <typename Then>
  auto still(Then then) {
    return [self = shared_from_this(), exchange = exchange_, then](const asio::error_code& error, auto... rest) {
      if (exchange == self->exchange_) then(*self, error, std::move(rest)...);
    };
  }

  void expire() {
    deadline_.expires_after(kAnswerTimeout);
    deadline_.async_wait(still([](State& self, const asio::error_code& error) {
      if (!error) self.fail({ErrorCode::kTimeout, self.server_.authority() + " does not answer in time"});
    }));
  }

  void resolve() {
    if (server_.carrier == Carrier::kTcp) {
      return fail({ErrorCode::kUrl, server_.authority() + " speaks no HTTP: give an http:// address", false});
    }
    resolver_.async_resolve(
        server_.host, std::to_string(server_.port),
        still([](State& self, const asio::error_code& error, const tcp::resolver::results_type& found) {
          if (error) return self.fail({ErrorCode::kResolve, "no address for " + self.server_.host});
          self.connect(found);
        }));
  }

  void connect(const tcp::resolver::results_type& found) {
    socket_.async_open(found, still([](State& self, const asio::error_code& error) {
                         if (error) return self.fail_with(error);
                         self.socket_.set_no_delay();
                         self.is_connected_ = true;
                         self.write();
                       }));
  }

  void write() {
    sent_ = Clock::now();
    has_first_byte_ = false;
    asio::async_write(socket_, asio::buffer(request_),
                      still([](State& self, const asio::error_code& error, std::size_t) {
                        error ? self.begin_again_or_fail(error) : self.read();
                      }));
  }

  void read() {
    socket_.async_read_some(asio::buffer(input_),
                            still([](State& self, const asio::error_code& error, std::size_t size) {
                              if (error && (error != asio::error::eof || !self.has_first_byte_)) {
                                return self.begin_again_or_fail(error);
                              }
                              self.take(std::span(self.input_).first(error ? 0 : size), !error);
                            }));
  }

  void take(std::span<const char> bytes, bool goes_on) {
    if (!std::exchange(has_first_byte_, true)) first_byte_ = Clock::now() - sent_;
    switch (reader_->feed(bytes)) {
      case HttpReader::State::kWhole: {
        Outcome outcome{reader_->take(), first_byte_, Clock::now() - sent_};
        if (!reader_->is_kept_open() || !goes_on) disconnect();
        return end(std::move(outcome));
      }
      case HttpReader::State::kMore:
        if (goes_on) return read();
        [[fallthrough]];
      case HttpReader::State::kBroken:
        return fail({ErrorCode::kHttp, server_.authority() + " does not answer in HTTP"});
      case HttpReader::State::kTooLarge:
        return fail({ErrorCode::kHttp, "the answer is too large"});
    }
  }

  /// A kept connection may have been closed while nobody looked: once, the request is made on a new one.
  void begin_again_or_fail(const asio::error_code& error) {
    if (is_fresh_ || has_first_byte_) return fail_with(error);
    is_fresh_ = true;
    ++exchange_;
    disconnect();
    expire();
    resolve();
  }

  void fail_with(const asio::error_code& error) {
    fail({ErrorCode::kConnect, "no connection to " + server_.authority() + " (" + error.message() + ")"});
  }
  void fail(ClientError error) {
    disconnect();
    end({std::unexpected(std::move(error)), {}, {}});
  }

  /// The last step of every exchange. `done` may begin the next one.
  void end(Outcome outcome) {
    ++exchange_;
    deadline_.cancel();
    const Done done = std::exchange(done_, {});
    if (done) done(std::move(outcome));
  }

  const ServerAddress server_;
  tcp::resolver resolver_;
  ClientSocket socket_;
  asio::steady_timer deadline_;
  std::string request_;
  Done done_;
  std::unique_ptr<HttpReader> reader_ = std::make_unique<HttpReader>();
  std::array<char, 16 * 1024> input_{};
  Clock::time_point sent_{};
  std::chrono::nanoseconds first_byte_{};
  std::uint64_t exchange_ = 0;
  bool has_first_byte_ = false;
  bool is_connected_ = false;
  bool is_fresh_ = false;  ///< the connection was made for this request
};

HttpClient::HttpClient(Loop& loop, const ServerAddress& server)
    : state_(std::make_shared<State>(loop.context(), server)) {}

HttpClient::~HttpClient() {
  state_->abandon();
}

void HttpClient::get(const std::string& target, Done done) {
  state_->get(target, std::move(done));
}

bool HttpClient::is_waiting() const {
  return state_->is_waiting();
}

}  // namespace talus::client
