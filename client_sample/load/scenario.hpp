// Who comes to the server, how many of each, and what they do. Pure data, out of a TOML file and the command line.
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "client_sample/library/server_address.hpp"
#include "protocol/toml_reader.hpp"

namespace talus::load {

enum class BotKind : std::uint8_t {
  kWalk,       ///< a viewer on the ground
  kFly,        ///< a viewer 200 m above it
  kTeleport,   ///< a viewer that jumps every `every_s`
  kReconnect,  ///< a viewer that drops its connection every `every_s` and resumes with what it holds
  kSlow,       ///< a viewer that returns its credit at `rate` bytes a second
  kStall,      ///< a viewer that grants much and then reads no more: the server should cut it
  kScan,       ///< wants random far chunks by name, as fast as they come
  kFetch,      ///< asks for chunks of one view over HTTP, round and round: the first round is cold, the rest is not
  kEnd
};
inline constexpr std::size_t kBotKinds = static_cast<std::size_t>(BotKind::kEnd);
/// "walk", "fly" ... as sections of a scenario file are called.
std::string_view name_of(BotKind kind);

struct Group {
  int count = 0;
  double spread_m = 5000;  ///< bots begin within this of the scenario's place
  double speed_m_s = 20;
  double every_s = 5;
  double far_m = 2000;
  double rate = 0;        ///< kSlow: bytes a second; kFetch: requests a second, 0: as fast as they are answered
  double start_s = 0;     ///< the first comes then
  double ramp_s = 0;      ///< the last comes this much later
  double credit_mib = 4;  ///< bytes under way to each, at most
  client::Carrier carrier = client::Carrier::kWebSocket;
};

struct Scenario {
  double seconds = 30;
  double x_m = 0;
  double z_m = 0;
  double near_m = 128;
  std::int64_t seed = 1;
  int verified = 4;  ///< viewers of each group whose every chunk is followed, for latencies and conservation
  int samples = 32;  ///< payloads that are compared with the world evaluated here
  std::array<Group, kBotKinds> groups;

  Scenario();
  Group& group(BotKind kind) { return groups[static_cast<std::size_t>(kind)]; }
  const Group& group(BotKind kind) const { return groups[static_cast<std::size_t>(kind)]; }
  int bots() const;
};

/// Every fault with its line; keys that `text` does not set keep their defaults.
std::expected<Scenario, std::vector<protocol::TextFault>> parse_scenario(std::string_view text, std::string_view file);

}  // namespace talus::load
