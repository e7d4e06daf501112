// Between a viewer and its socket: asks the chunk service for what the viewer wants, hands the writer what the client
// can take. Owner: one session, on its thread; pool threads post to it.
#pragma once

#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/net/frame_writer.hpp"
#include "server/net/net_context.hpp"
#include "server/world/viewer.hpp"

namespace talus::server {

class ChunkFeed {
 public:
  /// `net`, `limits` and `writer` must outlive the feed; `owner` keeps the feed alive while an answer is under way.
  /// Counts as a session from here to its destruction. `client` is whose share of the pool its chunks take.
  /// `format` (of kMeshFormats) is what the client decodes, `version` the protocol's that it speaks.
  ChunkFeed(NetContext& net, const NetLimits& limits, FrameWriter& writer, std::size_t world, const MeshFormat& format,
            std::uint64_t credit_bytes, std::uint16_t version, ClientId client,
            asio::io_context::executor_type executor, std::weak_ptr<void> owner);
  ~ChunkFeed();
  ChunkFeed(const ChunkFeed&) = delete;
  ChunkFeed& operator=(const ChunkFeed&) = delete;

  /// False when the message is not a viewer's.
  bool on_message(const protocol::Message& message) { return viewer_.on_message(message); }
  /// Looks at the latest view if it is time, then requests and sends as far as window, credit and queue allow. Cheap
  /// when there is nothing to do.
  void advance();
  /// Nobody wants anything any more.
  void close();

 private:
  void refresh();
  void pump();
  bool request_next();
  void on_piece(const Piece& piece, const ChunkResult& result);
  void fail(const Piece& piece);
  void offer(const Piece& piece, PayloadRef payload);
  std::size_t window() const;

  NetContext& net_;
  const NetLimits& limits_;
  FrameWriter& writer_;
  const std::size_t world_;
  const MeshFormat& format_;
  const bool takes_failures_;
  const ClientId client_;
  const asio::io_context::executor_type executor_;
  const std::weak_ptr<void> owner_;
  Viewer viewer_;
  /// Made, and waiting for credit.
  struct Ready {
    Piece piece;
    OutFrame frame;
    unsigned faces = 0;
  };

  std::unordered_map<Piece, ChunkService::Ticket, PieceHash> tickets_;
  std::vector<Ready> ready_;
  Instant retry_at_{};
  Instant refresh_at_{};
  bool is_closed_ = false;
};

}  // namespace talus::server
