#include "server/app/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "server/net/allowed_origins.hpp"
#include "server/net/endpoint.hpp"
#include "server/net/trusted_proxies.hpp"
#include "server/observe/json.hpp"
#include "server/observe/log.hpp"

namespace talus::server {

namespace {

template <auto Member>
auto& of_settings(Settings& s) {
  return s.*Member;
}
template <auto Member>
auto& of_limits(Settings& s) {
  return s.limits.*Member;
}
using S = Settings;
using L = NetLimits;

// clang-format off
const std::array kTable{
  SettingInfo{"world", &of_settings<&S::world>, 0, 64, "FILE", "A world's manifest (TOML); repeatable. Without it the built-in world, named default."},
  SettingInfo{"listen", &of_settings<&S::listen>, 0, 0, "ADDR:PORT", "Where HTTP and WebSocket are spoken; port 0 takes a free one."},
  SettingInfo{"tcp_listen", &of_settings<&S::tcp_listen>, 0, 0, "ADDR:PORT", "Where the streaming protocol is spoken over plain TCP; off: not at all."},
  SettingInfo{"admin_listen", &of_settings<&S::admin_listen>, 0, 0, "ADDR:PORT", "Where /metrics is; keep it off public networks. off: nowhere."},
  SettingInfo{"tls_certificate", &of_settings<&S::tls_certificate>, 0, 0, "FILE", "Certificate chain in PEM, leaf first: https and wss instead of http and ws."},
  SettingInfo{"tls_key", &of_settings<&S::tls_key>, 0, 0, "FILE", "Its private key in PEM, without a password."},
  SettingInfo{"tls_on", &of_settings<&S::tls_on>, 0, 3, "LISTENER", "Where TLS is spoken when there is a certificate: listen, tcp_listen, admin_listen; repeatable. Without it the first two."},
  SettingInfo{"token_keys", &of_settings<&S::token_keys>, 0, 16, "FILE", "Key of join tokens; repeatable, each opens. With one, worlds are read with a token only."},
  SettingInfo{"allowed_origins", &of_settings<&S::allowed_origins>, 0, 64, "ORIGIN", "Whose web pages may read and stream, such as https://maps.example.org; repeatable. Without it any."},
  SettingInfo{"trusted_proxies", &of_settings<&S::trusted_proxies>, 0, 64, "ADDR", "Address or network whose X-Forwarded-For is believed, such as 127.0.0.1 or 10.0.0.0/8; repeatable."},
  SettingInfo{"viewer", &of_settings<&S::viewer>, 0, 0, "DIR", "Folder of the built browser viewer, served at /."},
  SettingInfo{"threads", &of_settings<&S::threads>, 0, 1024, "N", "Threads that make terrain; 0 is one for each processor."},
  SettingInfo{"net_threads", &of_settings<&S::net_threads>, 0, 64, "N", "Threads that talk to peers; 0 is one for every four processors."},
  SettingInfo{"cache_mib", &of_settings<&S::cache_mib>, 1, 1048576, "N", "Memory for encoded chunks: more means fewer are made twice."},
  SettingInfo{"disk_cache", &of_settings<&S::disk_cache>, 0, 0, "DIR", "Folder in which chunks outlive the server; may be deleted at any time. Without it none do."},
  SettingInfo{"disk_cache_mib", &of_settings<&S::disk_cache_mib>, 1, 16777216, "N", "Disk for chunks: beyond it the longest unused go."},
  SettingInfo{"log_level", &of_settings<&S::log_level>, 0, 0, "LEVEL", "debug, info, warning, error or off; JSON lines on standard error."},
  SettingInfo{"drain_s", &of_settings<&S::drain_s>, 0, 600, "S", "On SIGTERM, how long answers and sessions may take to end."},
  SettingInfo{"cold_queue", &of_settings<&S::cold_queue>, 1, 65536, "N", "Chunks that may wait to be made, in each lane: feet, view, cover, background; then 503.", true},
  SettingInfo{"cold_per_client", &of_settings<&S::cold_per_client>, 1, 65536, "N", "Chunks that may wait to be made for one stream, or for one address over HTTP; then 503.", true},
  SettingInfo{"job_s", &of_settings<&S::job_s>, 0.1, 3600, "S", "A chunk or a question whose making takes so long is given up, and its thread replaced; then 503.", true},
  SettingInfo{"pool_nice", &of_settings<&S::pool_nice>, 0, 19, "N", "How far threads that make terrain stand back for those that talk to peers, and for other programs; 0 not at all.", true},
  SettingInfo{"connections", &of_limits<&L::connections>, 1, 1000000, "N", "Connections in all.", true},
  SettingInfo{"connections_per_address", &of_limits<&L::connections_per_address>, 1, 1000000, "N", "Connections from one address.", true},
  SettingInfo{"request_line_bytes", &of_limits<&L::request_line_bytes>, 256, 65536, "N", "Longest HTTP request line; then 414.", true},
  SettingInfo{"head_bytes", &of_limits<&L::head_bytes>, 256, 65536, "N", "Largest block of HTTP header fields; then 431.", true},
  SettingInfo{"head_fields", &of_limits<&L::head_fields>, 1, 64, "N", "Most HTTP header fields; then 431.", true},
  SettingInfo{"body_bytes", &of_limits<&L::body_bytes>, 0, 1048576, "N", "Largest declared HTTP body; then 413. No route reads one.", true},
  SettingInfo{"requests_per_connection", &of_limits<&L::requests_per_connection>, 1, 1e9, "N", "HTTP requests before a connection is closed.", true},
  SettingInfo{"silent_s", &of_limits<&L::silent_s>, 0.1, 600, "S", "A new connection, or a stream without hello, may be silent so long.", true},
  SettingInfo{"head_s", &of_limits<&L::head_s>, 0.1, 600, "S", "From the first byte of a request's head to its last.", true},
  SettingInfo{"idle_s", &of_limits<&L::idle_s>, 0.1, 3600, "S", "Between two requests of a connection.", true},
  SettingInfo{"write_stall_s", &of_limits<&L::write_stall_s>, 0.1, 600, "S", "A peer that takes no byte for so long is reset.", true},
  SettingInfo{"read_rate_min", &of_limits<&L::read_rate_min>, 0, 1e9, "N", "Bytes a second that a peer takes at least, over write_stall_s; slower, it is reset.", true},
  SettingInfo{"wait_s", &of_limits<&L::wait_s>, 0.1, 600, "S", "A request waits so long for its chunk to be made; then 503.", true},
  SettingInfo{"ping_s", &of_limits<&L::ping_s>, 0.1, 3600, "S", "A silent stream is pinged after so long.", true},
  SettingInfo{"gone_s", &of_limits<&L::gone_s>, 0.2, 7200, "S", "A stream silent for so long is gone.", true},
  SettingInfo{"message_bytes", &of_limits<&L::message_bytes>, 1024, 65536, "N", "Largest message of a stream, by its declared length.", true},
  SettingInfo{"message_s", &of_limits<&L::message_s>, 0.1, 600, "S", "From the first byte of a message to its last.", true},
  SettingInfo{"messages_per_s", &of_limits<&L::messages_per_s>, 1, 100000, "N", "Messages of one stream, each 4 KiB counting as one more.", true},
  SettingInfo{"message_burst", &of_limits<&L::message_burst>, 17, 100000, "N", "Messages of one stream at once.", true},
  SettingInfo{"send_soft_bytes", &of_limits<&L::send_soft_bytes>, 65536, 1073741824, "N", "Queued for one stream beyond this, chunks are taken back.", true},
  SettingInfo{"send_hard_bytes", &of_limits<&L::send_hard_bytes>, 65536, 1073741824, "N", "Queued for one stream beyond this, it is reset.", true},
  SettingInfo{"pongs_queued", &of_limits<&L::pongs_queued>, 1, 1024, "N", "Control messages queued for one stream; beyond this pings go unanswered.", true},
  SettingInfo{"view_far_m", &of_limits<&L::view_far_m>, 64, 32768, "M", "Furthest that a view may reach; a view that asks for more is clamped to it, and told so.", true},
  SettingInfo{"window_max", &of_limits<&L::window_max>, 2, 256, "N", "Chunks in the making at once for one stream.", true},
};
// clang-format on

/// What is built once, at the start.
constexpr std::array<std::string_view, 15> kFixed{
    "world",  "listen", "tcp_listen",     "admin_listen", "threads", "net_threads",     "cache_mib", "disk_cache",
    "viewer", "tls_on", "disk_cache_mib", "cold_queue",   "job_s",   "cold_per_client", "pool_nice"};

bool is_fixed(std::string_view key) {
  return std::find(kFixed.begin(), kFixed.end(), key) != kFixed.end();
}

std::string range_of(const SettingInfo& info) {
  return fmt::format("allowed {}..{}", protocol::format_number(info.low), protocol::format_number(info.high));
}

protocol::TomlField toml_field(const SettingInfo& info) {
  constexpr double kTextBytesMax = 4096;
  using protocol::TomlType;
  switch (info.place.index()) {
    case 0:
      return {info.key, TomlType::kText, 0, kTextBytesMax};
    case 1:
      return {info.key, TomlType::kTextList, 0, info.high};
    case 2:
      return {info.key, TomlType::kWhole, info.low, info.high};
    default:
      return {info.key, TomlType::kNumber, info.low, info.high};
  }
}

template <typename Number>
std::optional<std::string> set_number(Number& into, const SettingInfo& info, std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  const bool is_number = error == std::errc{} && at == end && std::isfinite(value);
  if (!is_number || (std::is_integral_v<Number> && value != std::floor(value))) {
    return fmt::format("'{}' is not a {}number, {}", text, std::is_integral_v<Number> ? "whole " : "", range_of(info));
  }
  if (value < info.low || value > info.high) return fmt::format("{} is out of range, {}", text, range_of(info));
  into = static_cast<Number>(value);
  return std::nullopt;
}

}  // namespace

std::span<const SettingInfo> setting_table() {
  return kTable;
}

std::string flag_of(const SettingInfo& info) {
  std::string flag = "--" + std::string(info.key);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::optional<std::string> set_from_text(Settings& settings, const SettingInfo& info, std::string_view text) {
  return std::visit(
      [&](auto place) -> std::optional<std::string> {
        auto& into = place(settings);
        using Value = std::remove_reference_t<decltype(into)>;
        if constexpr (std::is_same_v<Value, std::string>) {
          into = text;
          return std::nullopt;
        } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
          into.emplace_back(text);
          return std::nullopt;
        } else {
          return set_number(into, info, text);
        }
      },
      info.place);
}

std::expected<void, std::vector<protocol::TextFault>> set_from_toml(Settings& settings, std::string_view text,
                                                                    std::string_view file) {
  std::vector<protocol::TomlField> fields;
  fields.reserve(std::size(kTable));
  for (const SettingInfo& info : kTable) fields.push_back(toml_field(info));
  auto entries = protocol::read_toml(text, file, fields);
  if (!entries) return std::unexpected(std::move(entries.error()));
  for (protocol::TomlEntry& entry : *entries) {
    const SettingPlace& place = kTable[entry.field].place;
    if (const auto* of_text = std::get_if<0>(&place)) {
      (*of_text)(settings) = std::get<std::string>(std::move(entry.value));
    } else if (const auto* of_list = std::get_if<1>(&place)) {
      (*of_list)(settings) = std::get<std::vector<std::string>>(std::move(entry.value));
    } else if (const auto* of_whole = std::get_if<2>(&place)) {
      (*of_whole)(settings) = static_cast<std::size_t>(std::get<std::int64_t>(entry.value));
    } else {
      std::get<3>(place)(settings) = std::get<double>(entry.value);
    }
  }
  // What only the whole can show is told with its line as well.
  std::vector<protocol::TextFault> faults;
  for (SettingFault& fault : setting_faults(settings)) {
    const auto entry =
        std::find_if(entries->begin(), entries->end(), [&](const auto& e) { return kTable[e.field].key == fault.key; });
    if (entry == entries->end()) continue;
    faults.push_back({std::string(file), entry->line, std::string(fault.key), std::move(fault.message)});
  }
  if (!faults.empty()) return std::unexpected(std::move(faults));
  return {};
}

std::vector<SettingFault> setting_faults(const Settings& settings) {
  std::vector<SettingFault> faults;
  const auto check_address = [&](std::string_view key, const std::string& text, bool may_be_off) {
    if (may_be_off && text == "off") return;
    if (const auto endpoint = parse_endpoint(text); !endpoint) {
      faults.push_back({key, fmt::format("'{}': {}{}", text, endpoint.error(), may_be_off ? ", or off" : "")});
    }
  };
  check_address("listen", settings.listen, false);
  check_address("tcp_listen", settings.tcp_listen, true);
  check_address("admin_listen", settings.admin_listen, true);
  if (const auto origins = AllowedOrigins::parse(settings.allowed_origins); !origins) {
    faults.push_back({"allowed_origins", origins.error()});
  }
  if (const auto proxies = TrustedProxies::parse(settings.trusted_proxies); !proxies) {
    faults.push_back({"trusted_proxies", proxies.error()});
  }
  if (settings.tls_certificate.empty() != settings.tls_key.empty()) {
    faults.push_back({settings.tls_key.empty() ? "tls_certificate" : "tls_key",
                      "a certificate and its key belong together: give tls_certificate and tls_key"});
  }
  for (const std::string& name : settings.tls_on) {
    if (name == "listen" || name == "tcp_listen" || name == "admin_listen") continue;
    faults.push_back({"tls_on", fmt::format("'{}': expected listen, tcp_listen or admin_listen", name)});
  }
  if (!settings.tls_on.empty() && settings.tls_certificate.empty()) {
    faults.push_back({"tls_on", "there is no TLS without tls_certificate and tls_key"});
  }
  if (!log_level(settings.log_level)) {
    faults.push_back(
        {"log_level", fmt::format("'{}': expected debug, info, warning, error or off", settings.log_level)});
  }
  if (settings.limits.send_hard_bytes < settings.limits.send_soft_bytes) {
    faults.push_back({"send_hard_bytes", "is below send_soft_bytes"});
  }
  if (settings.limits.gone_s <= settings.limits.ping_s) {
    faults.push_back({"gone_s", "is not above ping_s: every silent stream would be gone before its pong"});
  }
  return faults;
}

std::vector<std::string_view> fixed_differences(const Settings& a, const Settings& b) {
  std::vector<std::string_view> out;
  Settings left = a;
  Settings right = b;
  for (const SettingInfo& info : kTable) {
    const bool is_same = std::visit([&](auto place) { return place(left) == place(right); }, info.place);
    if (!is_same && is_fixed(info.key)) out.push_back(info.key);
  }
  return out;
}

std::string format_settings(const Settings& settings) {
  Settings copy = settings;
  std::string out =
      "# Settings of talusd. Every key has a flag of the same name: cache_mib is --cache-mib. SIGHUP reads this file "
      "again;\n"
      "# what is marked with 'at start' waits for the next one.\n";
  for (const SettingInfo& info : kTable) {
    const bool is_number = info.place.index() >= 2;
    fmt::format_to(std::back_inserter(out), "\n# {}{}{}\n{} = ", info.meaning,
                   is_number ? " (" + range_of(info) + ")" : "", is_fixed(info.key) ? " [at start]" : "", info.key);
    std::visit(
        [&](auto place) {
          const auto& value = place(copy);
          using Value = std::remove_cvref_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, std::string>) {
            append_json_string(out, value);  // JSON's strings are TOML's basic strings
          } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
            out += '[';
            for (const std::string& one : value) {
              if (out.back() != '[') out += ", ";
              append_json_string(out, one);
            }
            out += ']';
          } else {
            out += protocol::format_number(static_cast<double>(value));
          }
        },
        info.place);
    out += '\n';
  }
  return out;
}

}  // namespace talus::server
