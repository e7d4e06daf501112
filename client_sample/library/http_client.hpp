// One kept HTTP connection for programs with many requests: one GET after another, answers as callbacks on the loop.
// Owner: the thread of the loop.
#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <string>

#include "client_sample/library/client_error.hpp"
#include "client_sample/library/connection.hpp"
#include "client_sample/library/http_reader.hpp"
#include "client_sample/library/server_address.hpp"

namespace talus::client {

class HttpClient {
 public:
  struct Outcome {
    std::expected<HttpAnswer, ClientError> answer;  ///< any status is an answer; no redirect is followed
    std::chrono::nanoseconds first_byte{};          ///< from the request's sending to its answer's first byte
    std::chrono::nanoseconds whole{};               ///< to its last
  };
  using Done = std::function<void(Outcome)>;

  /// Longest wait for an answer: longer than a server lets a chunk wait (30 s).
  static constexpr std::chrono::seconds kAnswerTimeout{40};

  HttpClient(Loop& loop, const ServerAddress& server);
  /// An answer under way is dropped; no callback runs any more. Not from inside a callback.
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// `target` begins with a slash and has no blanks. Requires that nothing is under way; `done` is called once and may
  /// ask for the next. The connection is made when it is needed and kept for as long as the server keeps it.
  void get(const std::string& target, Done done);
  bool is_waiting() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace talus::client
