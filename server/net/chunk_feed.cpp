#include "server/net/chunk_feed.hpp"

#include <algorithm>
#include <utility>

#include "protocol/limits.hpp"

namespace talus::server {

namespace {

/// Chunks in the making, of all sessions together: most of what a lane of the pool queues.
constexpr std::size_t kWindowsSum = 192;
constexpr std::size_t kWindowMin = 2;
constexpr double kRetryS = 0.1;  ///< after the pool was full
/// A view is turned into an interest area at most this often, and all sessions together spend at most about a quarter
/// of one thread on it.
constexpr double kRefreshS = 0.05;
constexpr double kRefreshMaxS = 0.5;
constexpr std::size_t kRefreshShare = 4;
/// Nothing is requested while this much is queued: what is queued can no longer be overtaken by what is nearer.
constexpr std::size_t kPumpBelowBytes = 256 * 1024;

}  // namespace

ChunkFeed::ChunkFeed(NetContext& net, const NetLimits& limits, FrameWriter& writer, std::size_t world,
                     const MeshFormat& format, std::uint64_t credit_bytes, std::uint16_t version, ClientId client,
                     asio::io_context::executor_type executor, std::weak_ptr<void> owner)
    : net_(net),
      limits_(limits),
      writer_(writer),
      world_(world),
      format_(format),
      takes_failures_(version >= protocol::kVersionOfFailures),
      client_(client),
      executor_(std::move(executor)),
      owner_(std::move(owner)),
      viewer_(net.worlds[world]->shape(), credit_bytes, version >= protocol::kVersionOfStrips, limits.view_far_m) {
  net_.sessions.fetch_add(1, std::memory_order_relaxed);
}

ChunkFeed::~ChunkFeed() {
  net_.sessions.fetch_sub(1, std::memory_order_relaxed);
}

void ChunkFeed::advance() {
  if (is_closed_) return;
  if (viewer_.is_stale() && net_.clock.now() >= refresh_at_) refresh();
  pump();
}

void ChunkFeed::close() {
  is_closed_ = true;
  tickets_.clear();
  ready_.clear();
}

void ChunkFeed::refresh() {
  const Instant start = net_.clock.now();
  const Viewer::Change change = viewer_.refresh();
  for (const Piece& piece : change.cancelled) {
    tickets_.erase(piece);
    std::erase_if(ready_, [&](const Ready& ready) { return ready.piece == piece; });
  }
  for (const WantedPiece& moved : change.moved) {
    const auto found = tickets_.find(moved.piece);
    if (found != tickets_.end()) found->second.set_urgency(lane_of(moved), moved.urgency);
  }
  if (change.accepted) {
    if (change.is_cut_short) net_.metrics.add(Count::kViewCutShort);
    writer_.send_control(*change.accepted);
  }
  // Behind the chunks that are queued already: a chunk must not come after its own leave.
  for (std::size_t i = 0; i < change.leave.size(); i += protocol::kKeysPerMessageMax) {
    const std::size_t count = std::min(protocol::kKeysPerMessageMax, change.leave.size() - i);
    const auto first = change.leave.begin() + static_cast<std::ptrdiff_t>(i);
    writer_.send_bulk(protocol::Leave{{first, first + static_cast<std::ptrdiff_t>(count)}});
  }
  const Instant now = net_.clock.now();
  const auto sessions = static_cast<Duration::rep>(net_.sessions.load(std::memory_order_relaxed) * kRefreshShare);
  // A pause of the machine is not a cost: beyond half a second a viewer would feel it.
  refresh_at_ = now + std::clamp((now - start) * sessions, seconds(kRefreshS), seconds(kRefreshMaxS));
}

std::size_t ChunkFeed::window() const {
  const std::size_t sessions = std::max<std::size_t>(1, net_.sessions.load(std::memory_order_relaxed));
  return std::clamp(kWindowsSum / sessions, kWindowMin, std::max(kWindowMin, limits_.window_max));
}

void ChunkFeed::pump() {
  if (is_closed_) return;
  while (!ready_.empty()) {
    auto& [piece, frame, faces] = ready_.front();
    if (viewer_.deliver(piece, frame.message_bytes(), faces) == Viewer::Delivery::kNoCredit) break;
    writer_.send_chunk(std::move(frame));
    ready_.erase(ready_.begin());
  }
  const Instant now = net_.clock.now();
  while (ready_.empty() && now >= retry_at_ && viewer_.in_flight() < window() && writer_.bytes() < kPumpBelowBytes) {
    if (!request_next()) break;
  }
  if (const auto idle = viewer_.take_idle()) writer_.send_bulk(*idle);
}

/// False when there is nothing to request, or no place for it now.
bool ChunkFeed::request_next() {
  const auto next = viewer_.next_request();
  if (!next) return false;
  const Piece piece = next->piece;
  ChunkService::Done done = [this, owner = owner_.lock(), piece](ChunkResult result) mutable {
    asio::post(executor_,
               [this, owner = std::move(owner), piece, result = std::move(result)] { on_piece(piece, result); });
  };
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world_);
  name.key = piece.key;
  name.format = format_.chunk;
  if (piece.face) {
    name.format = format_.strip;
    name.face = *piece.face;
  }
  ChunkService::Answer answer = net_.chunks.request(name, {client_, lane_of(*next), next->urgency}, std::move(done));
  if (auto* payload = std::get_if<PayloadRef>(&answer)) {
    offer(piece, std::move(*payload));
  } else if (auto* ticket = std::get_if<ChunkService::Ticket>(&answer)) {
    tickets_[piece] = std::move(*ticket);
  } else if (std::get<ChunkError>(answer) == ChunkError::kFailed) {
    fail(piece);
  } else {
    viewer_.put_back(piece);
    retry_at_ = net_.clock.now() + seconds(kRetryS);
    return false;
  }
  return true;
}

void ChunkFeed::on_piece(const Piece& piece, const ChunkResult& result) {
  if (is_closed_ || tickets_.erase(piece) == 0) return;
  if (result) {
    offer(piece, *result);
  } else if (result.error() == ChunkError::kBusy) {
    viewer_.put_back(piece);
    retry_at_ = net_.clock.now() + seconds(kRetryS);
  } else {
    fail(piece);
  }
  pump();
}

/// It would fail again: the place stays as it is at the client, and the view can still become complete.
void ChunkFeed::fail(const Piece& piece) {
  const bool is_wanted = viewer_.deliver(piece, 0) == Viewer::Delivery::kSend;
  if (is_wanted && takes_failures_) writer_.send_bulk(protocol::Failed{piece.key, piece.face});
}

void ChunkFeed::offer(const Piece& piece, PayloadRef payload) {
  if (writer_.bytes() > limits_.send_soft_bytes) {
    net_.metrics.add(Count::kSendShed);
    return viewer_.put_back(piece);
  }
  const unsigned faces = payload->faces;
  OutFrame frame = piece.face ? writer_.strip_frame({piece.key, *piece.face}, std::move(payload))
                              : writer_.chunk_frame(piece.key, std::move(payload));
  switch (viewer_.deliver(piece, frame.message_bytes(), faces)) {
    case Viewer::Delivery::kSend:
      return writer_.send_chunk(std::move(frame));
    case Viewer::Delivery::kUnwanted:
      return;
    case Viewer::Delivery::kNoCredit:
      if (ready_.empty()) net_.metrics.add(Count::kCreditWaits);
      ready_.push_back({piece, std::move(frame), faces});
      return;
  }
}

}  // namespace talus::server
