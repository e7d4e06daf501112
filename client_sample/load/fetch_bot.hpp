// An HTTP client that asks for the chunks of one view, nearest first, round and round, on one kept connection.
#pragma once

#include <vector>

#include "client_sample/library/http_client.hpp"
#include "client_sample/load/bot.hpp"

namespace talus::load {

class FetchBot final : public Bot {
 public:
  /// Requires at least one key.
  FetchBot(Stage& stage, double start_s, std::vector<ChunkKey> keys);

  void tick(double now_s) override;
  void leave() override { is_leaving_ = true; }
  bool is_connected() const override { return asked_ > 0; }

 private:
  void ask();
  void take(const client::HttpClient::Outcome& outcome, const ChunkKey& key, bool is_again);
  KindReport& mine() { return stage_.report.of(BotKind::kFetch); }

  Stage& stage_;
  const double start_s_;
  const std::vector<ChunkKey> keys_;
  std::uint64_t asked_ = 0;
  double next_s_ = 0;
  bool is_leaving_ = false;
  client::HttpClient client_;
};

}  // namespace talus::load
