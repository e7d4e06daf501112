#include "server/net/answer_writer.hpp"

#include <algorithm>
#include <utility>

namespace talus::server {

AnswerWriter::State AnswerWriter::begin(HttpAnswer&& answer, const HeadOptions& options, bool is_head_only,
                                        Instant now) {
  answer_ = std::move(answer);
  net_.metrics.add(count_of(answer_.status));
  write_head(answer_, options, head_);
  const auto body = answer_.body();
  const bool has_body = !is_head_only && answer_.status != 204 && answer_.status != 304;
  if (has_body) net_.metrics.add(Count::kHttpBodyBytes, body.size());
  unsent_ = {asio::buffer(head_), has_body ? asio::const_buffer(body.data(), body.size()) : asio::const_buffer{}};
  start_ = now;
  return write_some();
}

AnswerWriter::State AnswerWriter::begin_head(std::string head) {
  head_ = std::move(head);
  unsent_ = {asio::buffer(head_), asio::const_buffer{}};
  start_ = net_.clock.now();
  return write_some();
}

AnswerWriter::State AnswerWriter::write_some() {
  asio::error_code error;
  std::size_t sent = channel_.write_some(unsent_, error);
  if (error && error != asio::error::would_block) return State::kFailed;
  if (pace_.is_waiting()) pace_.took(sent, net_.clock.now());
  for (asio::const_buffer& buffer : unsent_) {
    const std::size_t of_this = std::min(sent, buffer.size());
    buffer += of_this;
    sent -= of_this;
  }
  if (unsent_[0].size() + unsent_[1].size() != 0) return State::kUnsent;
  end();
  return State::kSent;
}

Awaitable<bool> AnswerWriter::finish() {
  State state = State::kUnsent;
  while (state == State::kUnsent) {
    pace_.begin_wait(net_.clock.now());
    const asio::error_code error = co_await channel_.wait_writable();
    state = error ? State::kFailed : write_some();
  }
  pace_.end_wait();
  co_return state == State::kSent;
}

void AnswerWriter::end() {
  net_.metrics.record(Hop::kWriteLoop, net_.clock.now() - start_);
  // What is no longer cached must not stay with a connection that is idle.
  answer_.payload = nullptr;
  answer_.file = nullptr;
  answer_.text = std::string();
}

}  // namespace talus::server
