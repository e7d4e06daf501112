// Puts one answer at a time onto an HTTP connection's channel: one gather write of head and body, tried at once and
// waited for only if the kernel is full. Owner: one connection, on its thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "server/net/channel.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/net_context.hpp"
#include "server/net/read_pace.hpp"

namespace talus::server {

class AnswerWriter {
 public:
  /// Both must outlive the writer; `channel` may be moved from once nothing is unsent.
  AnswerWriter(NetContext& net, Channel& channel) : net_(net), channel_(channel) {}

  enum class State : std::uint8_t { kSent, kUnsent, kFailed };
  /// Writes as much as is taken at once. Of a HEAD's answer only the head. It is `now`.
  State begin(HttpAnswer&& answer, const HeadOptions& options, bool is_head_only, Instant now);
  /// Bytes that are a head already.
  State begin_head(std::string head);
  /// After kUnsent: writes what is left. False when the channel has failed.
  Awaitable<bool> finish();

  /// How the peer takes what is written; ask often.
  ReadPace::Verdict judge_pace(Instant now, const NetLimits& limits) { return pace_.judge(now, limits); }
  void end_wait() { pace_.end_wait(); }

 private:
  State write_some();
  void end();

  NetContext& net_;
  Channel& channel_;
  HttpAnswer answer_;
  std::string head_;
  std::array<asio::const_buffer, 2> unsent_{};
  Instant start_{};
  ReadPace pace_;
};

}  // namespace talus::server
