// The scanner: wants random far chunks by name, a batch at a time, as fast as the server gives them.
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "client_sample/library/world_stream.hpp"
#include "client_sample/load/bot.hpp"
#include "client_sample/load/ledger.hpp"

namespace talus::load {

class ScanBot final : public Bot {
 public:
  ScanBot(Stage& stage, double start_s, std::uint64_t seed);

  void tick(double now_s) override;
  void leave() override;
  bool is_connected() const override { return is_known_ && !is_over_; }

 private:
  void connect();
  void want_next();
  ChunkKey random_key();
  KindReport& mine() { return stage_.report.of(BotKind::kScan); }
  const Group& group() const { return stage_.scenario.group(BotKind::kScan); }
  void tell_faults();

  Stage& stage_;
  const double start_s_;
  std::mt19937_64 random_;
  double connected_s_ = 0;
  bool is_known_ = false;
  bool is_leaving_ = false;
  bool is_over_ = false;
  Ledger ledger_;
  std::optional<client::WorldStream> stream_;  ///< last: its handlers use all of the above
};

}  // namespace talus::load
