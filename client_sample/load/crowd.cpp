#include "client_sample/load/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include "client_sample/library/http_get.hpp"
#include "client_sample/load/fetch_bot.hpp"
#include "client_sample/load/scan_bot.hpp"
#include "client_sample/load/viewer_bot.hpp"

namespace talus::load {
namespace {

constexpr double kEyes_m = 2.0;
constexpr double kFlight_m = 200.0;
constexpr std::size_t kJumps = 8;          ///< places that a teleporting bot knows
constexpr std::size_t kPlacesAsked = 200;  ///< in one request: about 40 bytes each in a line of at most 8 KiB

/// Ways between random places; their heights are the ground's once `raise` has asked for it.
class Ways {
 public:
  Ways(const Stage& stage, std::uint64_t seed) : stage_(stage), random_(seed) {}

  /// Somewhere within the group's spread, towards anywhere, as far as its speed carries it.
  Way draw(const Group& group) {
    const double turn = uniform(0, 2 * std::numbers::pi);
    const double reach = group.spread_m * std::sqrt(uniform(0, 1));
    const double way = std::max(64.0, group.speed_m_s * stage_.scenario.seconds);
    const double ahead = uniform(0, 2 * std::numbers::pi);
    Way out;
    out.from = {stage_.scenario.x_m + reach * std::cos(turn), 0, stage_.scenario.z_m + reach * std::sin(turn)};
    out.to = out.from + glm::dvec3{way * std::cos(ahead), 0, way * std::sin(ahead)};
    out.speed_m_s = group.speed_m_s;
    return out;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }

  const Stage& stage_;
  std::mt19937_64 random_;
};

/// y of every place is the ground there, or the sea on it.
std::expected<void, std::string> stand_on_ground(const Stage& stage, std::span<glm::dvec3* const> places) {
  for (std::size_t at = 0; at < places.size(); at += kPlacesAsked) {
    const auto part = places.subspan(at, std::min(kPlacesAsked, places.size() - at));
    std::string target = "/v1/worlds/" + stage.world.name + "/points?xz=";
    for (const glm::dvec3* place : part) {
      if (place != part.front()) target += ';';
      // Whole metres keep the line short.
      target += std::to_string(std::llround(place->x)) + ',' + std::to_string(std::llround(place->z));
    }
    const auto answer = client::http_get(stage.http, target);
    if (!answer) return std::unexpected(answer.error().message);
    const std::vector<double> heights = client::parse_heights(answer->body);
    if (heights.size() != part.size()) return std::unexpected("/points answered " + client::error_text(answer->body));
    for (std::size_t i = 0; i < part.size(); ++i) part[i]->y = std::max(heights[i], stage.world.sea_level_m);
  }
  return {};
}

/// Who walks and would begin in the sea begins on the land next to it.
std::expected<void, std::string> come_ashore(const Stage& stage, Way& way) {
  if (way.from.y > stage.world.sea_level_m) return {};
  const auto answer = client::http_get(stage.http, "/v1/worlds/" + stage.world.name +
                                                       "/spawn?near=" + std::to_string(std::llround(way.from.x)) + ',' +
                                                       std::to_string(std::llround(way.from.z)));
  if (!answer) return std::unexpected(answer.error().message);
  const auto land = client::parse_spawn(answer->body);
  if (!land) return {};  // the world has none near here: one walks on water
  way.to = *land + glm::dvec3{way.to.x - way.from.x, 0, way.to.z - way.from.z};
  way.from = *land;
  return {};
}

struct Planned {
  BotKind kind{};
  double start_s = 0;
  bool is_verified = false;
  std::vector<Way> ways;
};

std::vector<Planned> plan(const Stage& stage) {
  std::vector<Planned> out;
  Ways ways(stage, static_cast<std::uint64_t>(stage.scenario.seed));
  for (std::size_t at = 0; at < kBotKinds; ++at) {
    const Group& group = stage.scenario.groups[at];
    for (int i = 0; i < group.count; ++i) {
      Planned bot;
      bot.kind = static_cast<BotKind>(at);
      bot.start_s = group.start_s + group.ramp_s * i / group.count;
      bot.is_verified = i < stage.scenario.verified;
      const std::size_t places = bot.kind == BotKind::kTeleport ? kJumps : 1;
      for (std::size_t place = 0; place < places; ++place) bot.ways.push_back(ways.draw(group));
      out.push_back(std::move(bot));
    }
  }
  return out;
}

/// Above the ground that was asked for; bots that jump stand still in between.
void rise(Planned& bot) {
  for (Way& way : bot.ways) {
    if (bot.kind == BotKind::kFly) {
      way.from.y = way.to.y = std::max(way.from.y, way.to.y) + kFlight_m;
    } else {
      way.from.y += kEyes_m;
      way.to.y += kEyes_m;
    }
    if (bot.kind == BotKind::kTeleport) way.speed_m_s = 0;
  }
}

/// The chunks of a view from where a fetching bot stands, nearest first.
std::vector<ChunkKey> keys_around(const Stage& stage, const glm::dvec3& place) {
  protocol::View view;
  view.position = place;
  view.near_m = stage.scenario.near_m;
  view.far_m = stage.scenario.group(BotKind::kFetch).far_m;
  view = protocol::clamped(view, stage.world.shape);
  std::vector<ChunkKey> keys;
  protocol::interest_area(view, stage.world.shape, keys);
  std::ranges::sort(keys, {}, [&](const ChunkKey& key) {
    return std::pair(protocol::chunk_urgency(view, stage.world.shape, key), key);
  });
  if (keys.empty()) keys.push_back({});
  return keys;
}

std::unique_ptr<Bot> make(Stage& stage, Planned bot, std::uint64_t seed) {
  if (bot.kind == BotKind::kScan) return std::make_unique<ScanBot>(stage, bot.start_s, seed);
  if (bot.kind == BotKind::kFetch) {
    return std::make_unique<FetchBot>(stage, bot.start_s, keys_around(stage, bot.ways.front().from));
  }
  return std::make_unique<ViewerBot>(stage,
                                     ViewerBot::Plan{bot.kind, std::move(bot.ways), bot.start_s, bot.is_verified});
}

}  // namespace

std::expected<Crowd, std::string> gather(Stage& stage) {
  std::vector<Planned> planned = plan(stage);
  std::vector<glm::dvec3*> places;
  for (Planned& bot : planned) {
    if (bot.kind == BotKind::kScan) continue;
    for (Way& way : bot.ways) places.insert(places.end(), {&way.from, &way.to});
  }
  if (auto asked = stand_on_ground(stage, places); !asked) return std::unexpected(asked.error());
  Crowd out;
  std::uint64_t seed = static_cast<std::uint64_t>(stage.scenario.seed);
  for (Planned& bot : planned) {
    if (bot.kind == BotKind::kWalk) {
      if (auto ashore = come_ashore(stage, bot.ways.front()); !ashore) return std::unexpected(ashore.error());
    }
    rise(bot);
    out.push_back(make(stage, std::move(bot), ++seed));
  }
  return out;
}

}  // namespace talus::load
