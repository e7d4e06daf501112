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

ChunkFeed::ChunkFeed(NetContext& net, FrameWriter& writer, std::size_t world, std::uint64_t credit_bytes,
                     asio::io_context::executor_type executor, std::weak_ptr<void> owner)
    : net_(net),
      writer_(writer),
      world_(world),
      executor_(std::move(executor)),
      owner_(std::move(owner)),
      viewer_(net.worlds[world]->shape(), credit_bytes) {
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
  for (const ChunkKey& key : change.cancelled) {
    tickets_.erase(key);
    std::erase_if(ready_, [&](const auto& ready) { return ready.first == key; });
  }
  for (const WantedChunk& chunk : change.moved) {
    if (const auto found = tickets_.find(chunk.key); found != tickets_.end()) found->second.set_urgency(chunk.urgency);
  }
  if (change.accepted) writer_.send_control(*change.accepted);
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
  return std::clamp(kWindowsSum / sessions, kWindowMin, std::max(kWindowMin, net_.limits.window_max));
}

void ChunkFeed::pump() {
  if (is_closed_) return;
  while (!ready_.empty()) {
    auto& [key, frame] = ready_.front();
    if (viewer_.deliver(key, frame.message_bytes()) == Viewer::Delivery::kNoCredit) break;
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
  ChunkService::Done done = [this, owner = owner_.lock(), key = next->key](ChunkResult result) mutable {
    asio::post(executor_, [this, owner = std::move(owner), key, result = std::move(result)] { on_chunk(key, result); });
  };
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world_);
  name.key = next->key;
  ChunkService::Answer answer = net_.chunks.request(name, Lane::kStream, next->urgency, std::move(done));
  if (auto* payload = std::get_if<PayloadRef>(&answer)) {
    offer(next->key, std::move(*payload));
  } else if (auto* ticket = std::get_if<ChunkService::Ticket>(&answer)) {
    tickets_[next->key] = std::move(*ticket);
  } else {
    viewer_.put_back(next->key);
    retry_at_ = net_.clock.now() + seconds(kRetryS);
    return false;
  }
  return true;
}

void ChunkFeed::on_chunk(const ChunkKey& key, const ChunkResult& result) {
  if (is_closed_ || tickets_.erase(key) == 0) return;
  if (result) {
    offer(key, *result);
  } else {
    // It would fail again: the place stays as it is at the client, and the view can still become complete.
    viewer_.deliver(key, 0);
  }
  pump();
}

void ChunkFeed::offer(const ChunkKey& key, PayloadRef payload) {
  if (writer_.bytes() > net_.limits.send_soft_bytes) {
    net_.metrics.add(Count::kSendShed);
    return viewer_.put_back(key);
  }
  OutFrame frame = writer_.chunk_frame(key, std::move(payload));
  switch (viewer_.deliver(key, frame.message_bytes())) {
    case Viewer::Delivery::kSend:
      return writer_.send_chunk(std::move(frame));
    case Viewer::Delivery::kUnwanted:
      return;
    case Viewer::Delivery::kNoCredit:
      if (ready_.empty()) net_.metrics.add(Count::kCreditWaits);
      ready_.emplace_back(key, std::move(frame));
      return;
  }
}

}  // namespace talus::server
