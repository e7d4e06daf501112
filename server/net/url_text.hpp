// Numbers and names in URLs and header fields, read strictly: one spelling each. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus::server {

/// Without the spaces and tabs around it.
std::string_view trimmed(std::string_view text);

/// A whole number as `-?(0|[1-9][0-9]*)`, but not "-0"; within +-2^31. Nothing for any other spelling.
std::optional<std::int32_t> whole_number(std::string_view text);

/// A finite decimal number as std::from_chars reads it (no "+", no "nan", no "inf", no hexadecimal), at most 40 bytes.
std::optional<double> decimal_number(std::string_view text);

/// `count` decimal numbers separated by single commas.
std::optional<std::vector<double>> decimal_numbers(std::string_view text, std::size_t count);

/// `%41` -> "A". Nothing when an escape is cut or not hexadecimal.
std::optional<std::string> percent_decoded(std::string_view text);

enum class QueryState : std::uint8_t { kAbsent, kMalformed, kTwice, kPresent };
struct QueryValue {
  QueryState state = QueryState::kAbsent;
  std::string value;  ///< decoded
};
/// The value of `name` in `a=b&c=d`; names are compared as sent.
QueryValue query_value(std::string_view query, std::string_view name);

/// Splits at every slash: "a//b" gives "a", "", "b". At most out.size() parts; the count, or nothing when there are
/// more.
std::optional<std::size_t> split_path(std::string_view path, std::span<std::string_view> out);

}  // namespace talus::server
