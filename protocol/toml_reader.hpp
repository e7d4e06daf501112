// Reads a TOML text against a table of the keys it may have. Manifests and the server's configuration are such texts.
// Every fault is found in one go and says file, line, key and what would be right. Pure; no toml++ type leaves the
// source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace talus::protocol {

inline constexpr std::size_t kTomlBytesMax = 1024 * 1024;
/// Further faults are counted, not listed.
inline constexpr std::size_t kTomlFaultsMax = 64;

/// One thing wrong with a text, ready to print: "worlds/alps.toml:12: erosion.gain: 3 is out of range, allowed 0..1".
struct TextFault {
  std::string file;
  std::uint32_t line = 0;  ///< from 1; 0 when the fault has no place
  std::string key;         ///< empty when the fault is not about one key
  std::string message;
};
std::string describe(const TextFault& fault);

enum class TomlType {
  kText,      ///< std::string; low..high bytes
  kWhole,     ///< std::int64_t; low..high
  kNumber,    ///< double; low..high, never NaN; whole numbers are numbers too
  kFlag,      ///< bool
  kTextList,  ///< std::vector<std::string>; low..high entries
  kUnsigned,  ///< std::uint64_t, all 64 bits: a whole number, or its digits as text where TOML's 63 bits do not reach
};
using TomlValue = std::variant<std::string, std::int64_t, double, bool, std::vector<std::string>, std::uint64_t>;

struct TomlField {
  std::string_view key;  ///< "section.key", or "key" above the first section
  TomlType type = TomlType::kText;
  double low = 0;
  double high = 0;
};

struct TomlEntry {
  std::size_t field = 0;   ///< index into the table
  std::uint32_t line = 0;  ///< from 1
  TomlValue value;         ///< holds the alternative of the field's type
};

/// What `text` sets, in order of the table. `file` only labels faults.
std::expected<std::vector<TomlEntry>, std::vector<TextFault>> read_toml(std::string_view text, std::string_view file,
                                                                        std::span<const TomlField> fields);

/// The entry of `candidates` that `word` was probably meant to be; empty when none is near.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// "section" of "section.key"; empty above the first section.
std::string_view section_of(std::string_view key);

/// The shortest decimal text, without exponent, that reads back as `value`.
std::string format_number(double value);

}  // namespace talus::protocol
