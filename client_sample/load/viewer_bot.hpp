// Bots that look: walk, fly, teleport, reconnect, slow and stall differ in how they move and in what they take.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "client_sample/library/world_stream.hpp"
#include "client_sample/load/bot.hpp"
#include "client_sample/load/ledger.hpp"

namespace talus::load {

class ViewerBot final : public Bot {
 public:
  struct Plan {
    BotKind kind = BotKind::kFly;
    std::vector<Way> ways;  ///< at least one; kTeleport jumps from one to the next, the others stay on the first
    double start_s = 0;
    bool is_verified = false;  ///< every chunk is followed; costs about 0.2 ms a look and 200 KiB
  };
  ViewerBot(Stage& stage, Plan plan);

  void tick(double now_s) override;
  void leave() override;
  bool is_connected() const override { return info_known_ && !is_over_; }

 private:
  void connect();
  client::StreamHandlers handlers();
  void look(double now_s);
  void drop_and_resume();
  void on_chunk(const client::ArrivedChunk& chunk);
  void on_idle(const protocol::Idle& idle);
  void on_closed(const client::ClientError& error);
  bool is_below(const ChunkKey& key) const;
  void tell_faults();
  KindReport& mine() { return stage_.report.of(plan_.kind); }
  const Group& group() const { return stage_.scenario.group(plan_.kind); }

  Stage& stage_;
  const Plan plan_;
  double connected_s_ = 0;  ///< when the present connection was begun
  double next_look_s_ = 0;
  double next_jump_s_ = 0;
  double paid_s_ = 0;  ///< until when a slow reader has returned its credit
  double stalled_s_ = 0;
  std::size_t way_ = 0;
  std::uint64_t owed_bytes_ = 0;
  protocol::View view_;
  bool info_known_ = false;
  bool has_chunk_ = false;
  bool has_ground_ = false;
  bool has_complete_ = false;
  bool is_resumed_ = false;
  bool is_stalled_ = false;
  bool is_leaving_ = false;
  bool is_over_ = false;
  bool has_looked_ = false;
  std::optional<Ledger> ledger_;
  std::optional<client::WorldStream> stream_;  ///< last: its handlers use all of the above
};

}  // namespace talus::load
