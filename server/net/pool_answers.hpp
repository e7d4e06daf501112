// What an HTTP connection waits for: chunks, and answers to questions about places, made by the pool.
// Owner: one connection, on its thread; pool threads post to it.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "server/net/http_answer.hpp"
#include "server/net/net_context.hpp"
#include "server/net/routes.hpp"
#include "server/net/socket.hpp"

namespace talus::server {

class PoolAnswers {
 public:
  PoolAnswers(NetContext& net, const asio::io_context::executor_type& executor)
      : net_(net), executor_(executor), bell_(executor) {}

  /// Whom these belong to; kept alive while something is under way. Before the first request.
  void belong_to(std::weak_ptr<void> owner) { owner_ = std::move(owner); }

  /// What a thread of the pool finds out. It owns what it needs: it may go on after the connection has ended.
  using Question = std::move_only_function<HttpAnswer(const World&)>;

  /// One at a time; of a route that asks the pool. 503 when the pool is full, the work failed or hangs, or `give_up`
  /// was called.
  Awaitable<HttpAnswer> make(Route route, ClientId client);
  /// The same of a question.
  Awaitable<HttpAnswer> ask(std::size_t world, ClientId client, Question question);

  /// Since when something is awaited; nothing when nothing is.
  std::optional<Instant> waiting_since() const { return waiting_since_; }
  /// Whoever waits is answered at once that it took too long.
  void give_up();

 private:
  Awaitable<HttpAnswer> chunk(PayloadName name, ClientId client);
  HttpAnswer unavailable(std::string_view code, std::string_view message) const {
    return unavailable_answer(net_.pool.wait_s(), code, message);
  }
  /// One that the operator has to hear of.
  HttpAnswer faulty(std::string_view code, std::string_view message) const {
    HttpAnswer answer = unavailable(code, message);
    answer.is_fault = true;
    return answer;
  }

  NetContext& net_;
  const asio::io_context::executor_type executor_;
  std::weak_ptr<void> owner_;
  Bell bell_;
  std::optional<Instant> waiting_since_;
  std::uint64_t asked_ = 0;  ///< number of what is under way: what comes for an earlier one is too late
  std::optional<ChunkResult> chunk_result_;
  std::optional<HttpAnswer> query_result_;
};

}  // namespace talus::server
