// What one streaming client sees, holds and still needs: a value without sockets, threads or clocks.
//
// Messages move it, `refresh` turns the latest view and want into a target, and the session asks it what to request
// next and whether the client can take what has come. Owner: the session's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/interest_area.hpp"
#include "protocol/message.hpp"

namespace talus::server {

/// A chunk to ask for, and how soon; smaller is sooner.
struct WantedChunk {
  ChunkKey key;
  double urgency = 0.0;
  friend bool operator==(const WantedChunk&, const WantedChunk&) = default;
};

class Viewer {
 public:
  /// `credit_bytes` is what the client can take at first.
  Viewer(const protocol::WorldShape& shape, std::uint64_t credit_bytes);

  /// View, Held, Want and Credit. False for a message that is not a viewer's: the client broke the protocol.
  bool on_message(const protocol::Message& message);

  /// Whether a view, want or held has come since the last refresh.
  bool is_stale() const { return is_stale_; }

  struct Change {
    std::optional<protocol::ViewAccepted> accepted;  ///< for the latest view, if there was a new one
    std::vector<ChunkKey> leave;                     ///< held by the client, no longer wanted
    std::vector<ChunkKey> cancelled;                 ///< in flight, no longer wanted
    std::vector<WantedChunk> moved;                  ///< in flight, still wanted, with their new urgency
  };
  /// Makes the latest view and want the target; the latest wins, those between are never looked at.
  Change refresh();

  /// The most urgent chunk that is neither held nor in flight; it is in flight from now on.
  std::optional<WantedChunk> next_request();
  /// A chunk in flight could not be had now: it is wanted again.
  void put_back(const ChunkKey& key);

  enum class Delivery { kSend, kNoCredit, kUnwanted };
  /// A chunk in flight has come. kSend: it counts as held, and its bytes as taken. kNoCredit: nothing changes, ask
  /// again after the next credit. kUnwanted: nobody waits for it.
  Delivery deliver(const ChunkKey& key, std::uint64_t message_bytes);

  /// Once after each refresh, when everything wanted has been delivered.
  std::optional<protocol::Idle> take_idle();

  std::size_t in_flight() const { return in_flight_; }
  std::uint64_t credit_bytes() const { return credit_bytes_; }

 private:
  enum class Phase : std::uint8_t { kWanted, kInFlight, kHeld };
  struct State {
    ChunkKey key;
    double urgency = 0.0;
    Phase phase = Phase::kWanted;
  };
  /// Sorted by key, each key once. A view has some 2,500 of these and changes ten times a second: a merge of two sorted
  /// vectors costs a tenth of what hash maps cost.
  using States = std::vector<State>;

  static void sort_unique(States& states);
  States target() const;
  State* find(const ChunkKey& key);
  void hold(const std::vector<protocol::HeldChunk>& chunks);
  void merge_into(States& next, Change& change) const;

  const protocol::WorldShape shape_;
  std::optional<protocol::ViewMessage> view_;  ///< the latest, clamped
  std::vector<ChunkKey> want_;                 ///< nearest first
  bool is_view_new_ = false;
  bool is_stale_ = false;

  States states_;
  std::vector<WantedChunk> queue_;  ///< a heap, most urgent first; entries whose phase has changed are skipped
  std::size_t in_flight_ = 0;
  std::size_t wanted_ = 0;
  bool is_idle_due_ = false;
  std::uint64_t credit_bytes_ = 0;
  std::uint64_t chunks_sent_ = 0;
};

}  // namespace talus::server
