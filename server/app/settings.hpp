// Every setting of the server in one table: key, type, range, default, meaning. The command line, the TOML file,
// --print-config and the help are all made from it.
#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/toml_reader.hpp"
#include "server/net/limits.hpp"

namespace talus::server {

struct Settings {
  std::vector<std::string> world;  ///< manifest files; empty: the built-in world
  std::string listen = "127.0.0.1:8080";
  std::string tcp_listen = "127.0.0.1:8081";
  std::string admin_listen = "127.0.0.1:9090";
  std::size_t threads = 0;      ///< 0: one for each processor
  std::size_t net_threads = 0;  ///< 0: one for every four processors, 1 to 8
  std::size_t cache_mib = 256;
  std::string disk_cache;  ///< folder; empty: none
  std::size_t disk_cache_mib = 4096;
  std::string viewer;                        ///< folder of the browser viewer; empty: none
  std::string tls_certificate;               ///< PEM file; empty: no TLS
  std::string tls_key;                       ///< PEM file
  std::vector<std::string> tls_on;           ///< listeners; empty: listen and tcp_listen
  std::vector<std::string> token_keys;       ///< files; empty: everybody may read
  std::vector<std::string> allowed_origins;  ///< empty: pages of any origin
  std::vector<std::string> trusted_proxies;  ///< addresses and networks
  std::string log_level = "info";
  double drain_s = 10;
  std::size_t cold_queue = 256;
  std::size_t cold_per_client = 64;
  double job_s = 20;
  std::size_t pool_nice = 5;
  NetLimits limits;
};

/// Where a setting lives. The alternative is its type.
using SettingPlace = std::variant<std::string& (*)(Settings&), std::vector<std::string>& (*)(Settings&),
                                  std::size_t& (*)(Settings&), double& (*)(Settings&)>;

struct SettingInfo {
  std::string_view key;  ///< in TOML; `--key-with-dashes` on the command line
  SettingPlace place;
  double low = 0;   ///< of numbers
  double high = 0;  ///< of numbers
  std::string_view value_name;
  std::string_view meaning;
  bool is_limit = false;  ///< one of the many that hardly anybody changes
};
std::span<const SettingInfo> setting_table();

/// `--cache-mib` for `cache_mib`.
std::string flag_of(const SettingInfo& info);

/// Sets one setting from a text of the command line. What is wrong with it, if anything. Lists grow by one.
std::optional<std::string> set_from_text(Settings& settings, const SettingInfo& info, std::string_view text);

/// Sets what `text` says. Every fault with file, line, key and allowed range.
std::expected<void, std::vector<protocol::TextFault>> set_from_toml(Settings& settings, std::string_view text,
                                                                    std::string_view file);

/// What no single range can say: addresses, levels. The key at fault and a sentence, or nothing.
struct SettingFault {
  std::string_view key;
  std::string message;
};
std::vector<SettingFault> setting_faults(const Settings& settings);

/// Keys of what differs and takes effect only at a start; the others may change while the server runs.
std::vector<std::string_view> fixed_differences(const Settings& a, const Settings& b);

/// A complete TOML file that gives `settings` back, each key with its meaning and range.
std::string format_settings(const Settings& settings);

}  // namespace talus::server
