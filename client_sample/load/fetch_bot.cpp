#include "client_sample/load/fetch_bot.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "core/base/check.hpp"

namespace talus::load {
namespace {

/// After a refusal; the server's Retry-After is whole seconds, longer than a tester has.
constexpr double kRefusedPause_s = 0.1;

std::string target_of(const std::string& world, const ChunkKey& key) {
  return "/v1/worlds/" + world + "/chunks/" + std::to_string(key.lod) + '/' + std::to_string(key.x) + '/' +
         std::to_string(key.y) + '/' + std::to_string(key.z) + ".drc";
}

}  // namespace

FetchBot::FetchBot(Stage& stage, double start_s, std::vector<ChunkKey> keys)
    : stage_(stage), start_s_(start_s), keys_(std::move(keys)), next_s_(start_s), client_(stage.loop, stage.http) {
  TALUS_CHECK(!keys_.empty());
}

void FetchBot::tick(double now_s) {
  if (now_s < start_s_ || now_s < next_s_ || is_leaving_ || client_.is_waiting()) return;
  ask();
}

void FetchBot::ask() {
  const ChunkKey key = keys_[asked_ % keys_.size()];
  const bool is_again = asked_ >= keys_.size();
  ++asked_;
  mine().count(Tally::kAsked);
  const double rate = stage_.scenario.group(BotKind::kFetch).rate;
  if (rate > 0) next_s_ = std::max(next_s_ + 1 / rate, stage_.now_s() - 1);
  client_.get(target_of(stage_.world.name, key),
              [this, key, is_again, rate](const client::HttpClient::Outcome& outcome) {
                take(outcome, key, is_again);
                if (rate <= 0 && stage_.now_s() >= next_s_ && !is_leaving_) ask();
              });
}

void FetchBot::take(const client::HttpClient::Outcome& outcome, const ChunkKey& key, bool is_again) {
  if (!outcome.answer) {
    if (is_leaving_) return;
    mine().count(Tally::kBroken);
    stage_.report.ended(outcome.answer.error().message);
    next_s_ = stage_.now_s() + kRefusedPause_s;
    return;
  }
  const client::HttpAnswer& answer = *outcome.answer;
  if (answer.status == 429 || answer.status == 503) {
    mine().count(Tally::kRefused);
    next_s_ = stage_.now_s() + kRefusedPause_s;
    return;
  }
  mine().count(Tally::kAnswered);
  if (answer.status != 200 && answer.status != 204) {
    return stage_.report.fault("fetch: " + target_of(stage_.world.name, key) + " answered " +
                               std::to_string(answer.status));
  }
  mine().record(is_again ? Measure::kFirstByteAgain : Measure::kFirstByte,
                std::chrono::duration<double>(outcome.first_byte).count());
  mine().count(Tally::kChunks);
  mine().count(Tally::kBytes, answer.body.size());
  ChunkKind kind = ChunkKind::kMesh;
  if (answer.status == 204) {
    const auto said = answer.fields.find("talus-chunk");
    kind = said != answer.fields.end() && said->second == "rock" ? ChunkKind::kRock : ChunkKind::kAir;
  } else {
    mine().count(Tally::kSurfaces);
  }
  stage_.samples.offer(key, kind, std::as_bytes(std::span(answer.body)));
}

}  // namespace talus::load
