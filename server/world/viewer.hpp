// What one streaming client sees, holds and still needs: a value without sockets, threads or clocks.
//
// Of strips it needs those between a chunk of the target and a held chunk one LOD finer whose surface reaches the face
// between them: they become wanted as the finer chunks are sent, so that no strip is asked for that would be empty. A
// strip is held for as long as its chunk is.
//
// Messages move it, `refresh` turns the latest view and want into a target, and the session asks it what to request
// next and whether the client can take what has come. Owner: the session's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/hash.hpp"
#include "core/grid/chunk_face.hpp"
#include "protocol/interest_area.hpp"
#include "protocol/limits.hpp"
#include "protocol/message.hpp"
#include "server/schedule/fair_queue.hpp"

namespace talus::server {

/// A chunk, or the strip of one of its faces.
struct Piece {
  ChunkKey key;
  std::optional<ChunkFace> face;  ///< nothing for the chunk itself
  friend auto operator<=>(const Piece&, const Piece&) = default;
};

struct PieceHash {
  std::size_t operator()(const Piece& piece) const noexcept {
    return mix64(ChunkKeyHash{}(piece.key), piece.face ? static_cast<std::uint64_t>(*piece.face) : kChunkFaces);
  }
};

/// A piece to ask for, and how soon; smaller is sooner.
struct WantedPiece {
  Piece piece;
  double urgency = 0.0;
  friend bool operator==(const WantedPiece&, const WantedPiece&) = default;
};

/// Where its job waits: what the viewer stands on, what it looks at, or the skyline.
Lane lane_of(const WantedPiece& wanted);

class Viewer {
 public:
  /// `credit_bytes` is what the client can take at first; `takes_strips` is false for clients of version 1.
  /// No view reaches further than `far_m_max`.
  Viewer(const protocol::WorldShape& shape, std::uint64_t credit_bytes, bool takes_strips,
         double far_m_max = protocol::kFarMax);

  /// View, Held, Want and Credit. False for a message that is not a viewer's: the client broke the protocol.
  bool on_message(const protocol::Message& message);

  /// Whether a view, want or held has come since the last refresh.
  bool is_stale() const { return is_stale_; }

  struct Change {
    std::optional<protocol::ViewAccepted> accepted;  ///< for the latest view, if there was a new one
    bool is_cut_short = false;                       ///< that view asked to see further than is allowed here
    std::vector<ChunkKey> leave;                     ///< held by the client, no longer wanted; with their strips
    std::vector<Piece> cancelled;                    ///< in flight, no longer wanted
    std::vector<WantedPiece> moved;                  ///< in flight, still wanted, with their new urgency
  };
  /// Makes the latest view and want the target; the latest wins, those between are never looked at.
  Change refresh();

  /// The most urgent piece that is neither held nor in flight; it is in flight from now on.
  std::optional<WantedPiece> next_request();
  /// A piece in flight could not be had now: it is wanted again.
  void put_back(const Piece& piece);

  enum class Delivery { kSend, kNoCredit, kUnwanted };
  /// A piece in flight has come. kSend: it counts as held, and its bytes as taken. kNoCredit: nothing changes, ask
  /// again after the next credit. kUnwanted: nobody waits for it. `faces` are those that a chunk's surface reaches.
  Delivery deliver(const Piece& piece, std::uint64_t message_bytes, unsigned faces = 0);

  /// Once after each refresh, when everything wanted has been delivered.
  std::optional<protocol::Idle> take_idle();

  std::size_t in_flight() const { return in_flight_; }
  std::uint64_t credit_bytes() const { return credit_bytes_; }

 private:
  enum class Phase : std::uint8_t { kWanted, kInFlight, kHeld };
  struct State {
    Piece piece;
    Phase phase = Phase::kWanted;
    std::uint8_t faces = 0;                                         ///< of a held chunk
    bool is_of_view = false;                                        ///< the view, or a chunk of the target, asks for it
    double want_urgency = std::numeric_limits<double>::infinity();  ///< of the client's own list, when that has it
  };
  /// In the order of the octree, which is that of the interest area, strips of a chunk by face; each once. A view has
  /// some 2,500 of these and changes ten times a second: a walk along two sorted vectors costs a tenth of what hash
  /// maps cost, and a third of sorting them.
  using States = std::vector<State>;

  static void sort_unique(States& states);
  static States::iterator place_in(States& states, const Piece& piece);
  static State* find_in(States& states, const Piece& piece);
  static void add_wants(States& states, States wants);
  States target() const;
  bool is_of_target(const ChunkKey& key);
  State* find(const Piece& piece) { return find_in(piece.face ? strips_ : chunks_, piece); }
  double urgency_of(const State& state);
  void hold(const protocol::Held& held);
  void merge_into(States& next, Change& change);
  template <class Visit>
  void for_each_strip_of(const State& finer, Visit visit);
  States strips_of_target();
  void merge_strips(const States& before, Change& change);
  void want_strips_of(const State& finer);

  const protocol::WorldShape shape_;
  std::optional<protocol::ViewMessage> view_;  ///< the latest, clamped
  std::vector<ChunkKey> want_;                 ///< nearest first
  std::vector<StripKey> want_strips_;
  const bool takes_strips_;
  const double far_m_max_;
  std::optional<protocol::InterestArea> area_;  ///< of the view at the last refresh
  bool is_view_new_ = false;
  bool is_view_cut_short_ = false;
  bool is_stale_ = false;

  States chunks_;
  States strips_;
  std::vector<WantedPiece> queue_;  ///< a heap, most urgent first; entries whose phase has changed are skipped
  std::size_t in_flight_ = 0;
  std::size_t wanted_ = 0;
  bool is_idle_due_ = false;
  std::uint64_t credit_bytes_ = 0;
  std::uint64_t chunks_sent_ = 0;
};

}  // namespace talus::server
