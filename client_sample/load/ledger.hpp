// What one viewer was promised and what it got: every chunk of a view or a want comes or is refused, once, and nothing
// else stays.
// Pure; times are seconds of one clock.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "protocol/interest_area.hpp"
#include "protocol/message.hpp"

namespace talus::load {

class Ledger {
 public:
  explicit Ledger(const protocol::WorldShape& shape) : shape_(shape) {}

  void looked(std::uint32_t sequence, double now_s);
  /// The interest area of the accepted view is asked for since that view was sent.
  void accepted(const protocol::ViewAccepted& accepted);
  void wanted(const std::vector<ChunkKey>& keys, double now_s);

  /// How long the chunk was waited for; nothing if it was not asked for any more, as happens when a view moves on.
  std::optional<double> came(const protocol::ChunkHead& head, double now_s);
  /// The server says that it cannot make the chunk: the other answer that counts.
  void refused(const ChunkKey& key);
  void left(const std::vector<ChunkKey>& keys);
  /// Everything must be here, and nothing besides.
  void complete(const protocol::Idle& idle);
  /// Another connection, which is told what is held; its views count from 1 again.
  void resumed();

  /// Sentences on what was wrong since the last call.
  std::vector<std::string> take_faults();
  /// By key, with the faces its surface reaches.
  const std::unordered_map<ChunkKey, std::uint8_t, ChunkKeyHash>& held() const { return held_; }

 private:
  void fault(const ChunkKey& key, const char* what);
  void ask(const std::vector<ChunkKey>& keys, double since_s);

  protocol::WorldShape shape_;
  std::map<std::uint32_t, double> looks_;  ///< sent, not accepted yet
  std::optional<std::uint32_t> accepted_;  ///< the latest
  std::uint32_t last_look_ = 0;
  std::vector<ChunkKey> expected_;                            ///< of the latest view and want, sorted
  std::unordered_map<ChunkKey, double, ChunkKeyHash> asked_;  ///< expected and not here, since when
  std::unordered_map<ChunkKey, std::uint8_t, ChunkKeyHash> held_;
  std::unordered_set<ChunkKey, ChunkKeyHash> refused_;  ///< and not left
  std::vector<std::string> faults_;
};

}  // namespace talus::load
