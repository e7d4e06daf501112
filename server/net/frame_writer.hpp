// Puts a session's frames onto its channel: two lanes, one gather write for many frames, payloads never copied.
// Owner: one session, on its thread.
#pragma once

#include <memory>
#include <vector>

#include "protocol/message.hpp"
#include "server/net/channel.hpp"
#include "server/net/framing.hpp"
#include "server/net/net_context.hpp"
#include "server/net/read_pace.hpp"
#include "server/net/send_queue.hpp"

namespace talus::server {

class FrameWriter {
 public:
  /// All must outlive the writer.
  FrameWriter(NetContext& net, Channel& channel, const Framing& framing);
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  void send_control(const protocol::Message& message);
  void send_bulk(const protocol::Message& message);
  /// The frame of a chunk or a strip, to be sent when its client can take it.
  OutFrame chunk_frame(const ChunkKey& key, PayloadRef payload) const;
  OutFrame strip_frame(const StripKey& strip, PayloadRef payload) const;
  void send_chunk(OutFrame frame);
  /// A frame of the framing's own, head and all; nothing when it is empty.
  void push_control(std::vector<std::byte> frame);
  void drop_bulk();

  bool empty() const { return queue_.empty(); }
  std::size_t bytes() const { return queue_.bytes(); }
  std::size_t control_frames() const { return queue_.control_frames(); }
  /// How the peer takes what is written; ask often.
  ReadPace::Verdict judge_pace(Instant now, const NetLimits& limits) { return pace_.judge(now, limits); }

  /// Returns when something was pushed, or `ring` was called.
  Awaitable<void> wait() { return bell_.wait(); }
  void ring() { bell_.ring(); }
  /// Takes the next frames from the queue and writes them whole. False when the channel has failed.
  Awaitable<bool> write_batch();

 private:
  /// Adds what the queue has gained or lost to what all sessions have queued.
  void tell_bytes();
  OutFrame frame_of(const protocol::Message& message) const;
  OutFrame payload_frame(const protocol::Message& head, PayloadRef payload) const;

  NetContext& net_;
  Channel& channel_;
  const Framing& framing_;
  SendQueue queue_;
  std::size_t told_bytes_ = 0;
  std::vector<OutFrame> batch_;
  std::vector<asio::const_buffer> buffers_;
  Bell bell_;
  ReadPace pace_;
};

}  // namespace talus::server
