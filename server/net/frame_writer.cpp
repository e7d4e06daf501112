#include "server/net/frame_writer.hpp"

#include <span>
#include <utility>

namespace talus::server {

namespace {

constexpr std::size_t kBatchFrames = 16;
constexpr std::size_t kBatchBytes = 128 * 1024;

}  // namespace

FrameWriter::FrameWriter(NetContext& net, Channel& channel, const Framing& framing)
    : net_(net), channel_(channel), framing_(framing), bell_(channel.executor()) {}

FrameWriter::~FrameWriter() {
  net_.queued_bytes.fetch_sub(told_bytes_, std::memory_order_relaxed);
}

void FrameWriter::tell_bytes() {
  // Unsigned: a loss wraps round, and so does the sum back.
  net_.queued_bytes.fetch_add(queue_.bytes() - told_bytes_, std::memory_order_relaxed);
  told_bytes_ = queue_.bytes();
}

void FrameWriter::drop_bulk() {
  queue_.drop_bulk();
  tell_bytes();
}

OutFrame FrameWriter::chunk_frame(const ChunkKey& key, PayloadRef payload) const {
  const auto bytes = static_cast<std::uint32_t>(payload->bytes.size());
  const protocol::ChunkHead head{key, 0, payload->kind, bytes, payload->faces};
  return payload_frame(head, std::move(payload));
}

OutFrame FrameWriter::strip_frame(const StripKey& strip, PayloadRef payload) const {
  const auto bytes = static_cast<std::uint32_t>(payload->bytes.size());
  return payload_frame(protocol::StripHead{strip, 0, bytes}, std::move(payload));
}

OutFrame FrameWriter::payload_frame(const protocol::Message& head, PayloadRef payload) const {
  OutFrame frame;
  frame.message = protocol::encode(head);
  frame.head = framing_.message_head(frame.message.size() + payload->bytes.size());
  if (!payload->bytes.empty()) frame.payload = std::move(payload);
  return frame;
}

void FrameWriter::send_chunk(OutFrame frame) {
  net_.metrics.add(Count::kChunksSent);
  net_.metrics.add(Count::kChunkBytesSent, frame.message_bytes());
  queue_.push_bulk(std::move(frame));
  tell_bytes();
  bell_.ring();
}

OutFrame FrameWriter::frame_of(const protocol::Message& message) const {
  OutFrame frame;
  frame.message = protocol::encode(message);
  frame.head = framing_.message_head(frame.message.size());
  return frame;
}

void FrameWriter::send_control(const protocol::Message& message) {
  queue_.push_control(frame_of(message));
  tell_bytes();
  bell_.ring();
}

void FrameWriter::send_bulk(const protocol::Message& message) {
  queue_.push_bulk(frame_of(message));
  tell_bytes();
  bell_.ring();
}

void FrameWriter::push_control(std::vector<std::byte> bytes_of_frame) {
  if (bytes_of_frame.empty()) return;
  OutFrame frame;
  frame.message = std::move(bytes_of_frame);
  queue_.push_control(std::move(frame));
  tell_bytes();
  bell_.ring();
}

Awaitable<bool> FrameWriter::write_batch() {
  const Instant start = net_.clock.now();
  queue_.pop_batch(kBatchFrames, kBatchBytes, batch_);
  tell_bytes();
  buffers_.clear();
  for (const OutFrame& frame : batch_) {
    buffers_.emplace_back(frame.head.bytes.data(), frame.head.size);
    buffers_.push_back(asio::buffer(frame.message));
    if (frame.payload != nullptr) buffers_.push_back(asio::buffer(frame.payload->bytes));
  }
  for (std::span<asio::const_buffer> left(buffers_); !left.empty();) {
    asio::error_code error;
    std::size_t sent = channel_.write_some(left, error);
    if (error && error != asio::error::would_block) co_return false;
    if (sent != 0) pace_.took(sent, net_.clock.now());
    while (!left.empty() && sent >= left.front().size()) {
      sent -= left.front().size();
      left = left.subspan(1);
    }
    if (left.empty()) break;
    left.front() += sent;
    pace_.begin_wait(net_.clock.now());
    if (co_await channel_.wait_writable()) co_return false;
  }
  if (queue_.empty()) pace_.end_wait();
  batch_.clear();
  net_.metrics.record(Hop::kWriteLoop, net_.clock.now() - start);
  co_return true;
}

}  // namespace talus::server
