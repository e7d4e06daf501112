#include "client_sample/load/scenario.hpp"

#include <utility>

#include "core/base/check.hpp"

namespace talus::load {
namespace {

using protocol::TextFault;
using protocol::TomlField;
using protocol::TomlType;

constexpr std::array<std::string_view, kBotKinds> kNames{"walk", "fly",   "teleport", "reconnect",
                                                         "slow", "stall", "scan",     "fetch"};

/// A number of a group or of the whole, and its limits.
template <typename Owner>
struct NumberKey {
  std::string_view key;
  double low = 0;
  double high = 0;
  double& (*place)(Owner&);
};

constexpr std::array<NumberKey<Group>, 8> kGroupNumbers{{
    {"spread_m", 0, 1e8, [](Group& g) -> double& { return g.spread_m; }},
    {"speed_m_s", 0, 1000, [](Group& g) -> double& { return g.speed_m_s; }},
    {"every_s", 0.1, 3600, [](Group& g) -> double& { return g.every_s; }},
    {"far_m", 0, 32768, [](Group& g) -> double& { return g.far_m; }},
    {"rate", 0, 1e9, [](Group& g) -> double& { return g.rate; }},
    {"start_s", 0, 86400, [](Group& g) -> double& { return g.start_s; }},
    {"ramp_s", 0, 86400, [](Group& g) -> double& { return g.ramp_s; }},
    {"credit_mib", 1, 1024, [](Group& g) -> double& { return g.credit_mib; }},
}};
constexpr std::array<NumberKey<Scenario>, 4> kNumbers{{
    {"seconds", 0.1, 86400, [](Scenario& s) -> double& { return s.seconds; }},
    {"x_m", -1e10, 1e10, [](Scenario& s) -> double& { return s.x_m; }},
    {"z_m", -1e10, 1e10, [](Scenario& s) -> double& { return s.z_m; }},
    {"near_m", 0, 4096, [](Scenario& s) -> double& { return s.near_m; }},
}};
constexpr double kBotsMax = 10'000;

/// One key of the file, and what setting it does; nothing, or why the value cannot be.
struct Key {
  std::string name;
  TomlField field;  ///< its key views `name`
  std::string_view (*set)(Scenario&, std::size_t group, std::size_t at, const protocol::TomlValue&);
  std::size_t group = 0;
  std::size_t at = 0;
};

std::string_view set_over(Scenario& scenario, std::size_t group, std::size_t, const protocol::TomlValue& value) {
  const auto& text = std::get<std::string>(value);
  if (text != "websocket" && text != "tcp") return "expected \"websocket\" or \"tcp\"";
  scenario.groups[group].carrier = text == "tcp" ? client::Carrier::kTcp : client::Carrier::kWebSocket;
  return {};
}

void add_group_keys(std::size_t group, std::vector<Key>& out) {
  const std::string section = std::string(kNames[group]) + '.';
  out.push_back({section + "count",
                 {{}, TomlType::kWhole, 0, kBotsMax},
                 [](Scenario& s, std::size_t g, std::size_t, const protocol::TomlValue& v) -> std::string_view {
                   s.groups[g].count = static_cast<int>(std::get<std::int64_t>(v));
                   return {};
                 },
                 group,
                 0});
  out.push_back({section + "over", {{}, TomlType::kText, 1, 16}, set_over, group, 0});
  for (std::size_t i = 0; i < kGroupNumbers.size(); ++i) {
    out.push_back({section + std::string(kGroupNumbers[i].key),
                   {{}, TomlType::kNumber, kGroupNumbers[i].low, kGroupNumbers[i].high},
                   [](Scenario& s, std::size_t g, std::size_t at, const protocol::TomlValue& v) -> std::string_view {
                     kGroupNumbers[at].place(s.groups[g]) = std::get<double>(v);
                     return {};
                   },
                   group,
                   i});
  }
}

template <auto kMember>
std::string_view set_whole(Scenario& scenario, std::size_t, std::size_t, const protocol::TomlValue& value) {
  using Member = std::remove_reference_t<decltype(scenario.*kMember)>;
  scenario.*kMember = static_cast<Member>(std::get<std::int64_t>(value));
  return {};
}

std::vector<Key> key_table() {
  std::vector<Key> out;
  for (std::size_t i = 0; i < kNumbers.size(); ++i) {
    out.push_back({std::string(kNumbers[i].key),
                   {{}, TomlType::kNumber, kNumbers[i].low, kNumbers[i].high},
                   [](Scenario& s, std::size_t, std::size_t at, const protocol::TomlValue& v) -> std::string_view {
                     kNumbers[at].place(s) = std::get<double>(v);
                     return {};
                   },
                   0,
                   i});
  }
  out.push_back({"seed", {{}, TomlType::kWhole, 0, 1e15}, set_whole<&Scenario::seed>, 0, 0});
  out.push_back({"verified", {{}, TomlType::kWhole, 0, kBotsMax}, set_whole<&Scenario::verified>, 0, 0});
  out.push_back({"samples", {{}, TomlType::kWhole, 0, 4096}, set_whole<&Scenario::samples>, 0, 0});
  for (std::size_t group = 0; group < kBotKinds; ++group) add_group_keys(group, out);
  for (Key& key : out) key.field.key = key.name;
  return out;
}

}  // namespace

std::string_view name_of(BotKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

Scenario::Scenario() {
  group(BotKind::kWalk).speed_m_s = 1.5;
  group(BotKind::kTeleport).spread_m = 50'000;
  group(BotKind::kSlow).rate = 64 * 1024;
  group(BotKind::kStall).credit_mib = 1024;
  group(BotKind::kScan).spread_m = 1e6;
  group(BotKind::kFetch).far_m = 500;
}

int Scenario::bots() const {
  int out = 0;
  for (const Group& one : groups) out += one.count;
  return out;
}

std::expected<Scenario, std::vector<TextFault>> parse_scenario(std::string_view text, std::string_view file) {
  const std::vector<Key> keys = key_table();
  std::vector<TomlField> fields;
  fields.reserve(keys.size());
  for (const Key& key : keys) fields.push_back(key.field);
  const auto entries = protocol::read_toml(text, file, fields);
  if (!entries) return std::unexpected(entries.error());
  Scenario out;
  std::vector<TextFault> faults;
  for (const protocol::TomlEntry& entry : *entries) {
    const Key& key = keys[entry.field];
    const std::string_view fault = key.set(out, key.group, key.at, entry.value);
    if (!fault.empty()) faults.push_back({std::string(file), entry.line, key.name, std::string(fault)});
  }
  if (!faults.empty()) return std::unexpected(std::move(faults));
  return out;
}

}  // namespace talus::load
