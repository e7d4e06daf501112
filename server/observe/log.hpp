// Structured logs: one JSON object a line on standard error. Any thread.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace talus::server {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError, kOff };
std::optional<LogLevel> log_level(std::string_view name);

/// A named value. Text from peers is welcome: it is escaped, and cut at kLogTextMax bytes.
struct LogField {
  std::string_view name;
  std::variant<std::string_view, std::int64_t, std::uint64_t, double, bool> value;
};
inline constexpr std::size_t kLogTextMax = 300;

/// Lines below `level` are not written. Starts at kInfo.
void set_log_level(LogLevel level);
bool is_logged(LogLevel level);

/// `event` is a fixed, greppable phrase; what varies goes into fields.
void log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

}  // namespace talus::server
