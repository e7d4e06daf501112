#include "protocol/toml_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <toml++/toml.h>

namespace talus::protocol {
namespace {

std::string_view name_of(toml::node_type type) {
  switch (type) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number with a fraction";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a section";
    default:
      return "a date or time";
  }
}

std::string_view wanted(TomlType type) {
  switch (type) {
    case TomlType::kText:
      return "a text in quotes";
    case TomlType::kWhole:
      return "a whole number";
    case TomlType::kNumber:
      return "a number";
    case TomlType::kFlag:
      return "true or false";
    case TomlType::kTextList:
      return "a list of texts";
    case TomlType::kUnsigned:
      return "a whole number from 0, or its digits in quotes";
  }
  return "";
}

std::string range_text(const TomlField& field) {
  return format_number(field.low) + ".." + format_number(field.high);
}

/// One reading of one text; collects entries and faults.
class Reading {
 public:
  Reading(std::string_view file, std::span<const TomlField> fields) : file_(file), fields_(fields) {
    for (const TomlField& field : fields) {
      keys_.push_back(field.key);
      const std::string_view section = section_of(field.key);
      if (!section.empty() && std::ranges::find(sections_, section) == sections_.end()) sections_.push_back(section);
    }
  }

  void read(const toml::table& root) {
    for (const auto& [key, node] : root) {
      const std::string name(key.str());
      const bool is_section = std::ranges::find(sections_, name) != sections_.end();
      if (is_section && node.is_table()) {
        read_section(name, *node.as_table());
      } else if (is_section) {
        fault(line_of(node), name, "is " + std::string(name_of(node.type())) + ", wanted a section: [" + name + "]");
      } else if (node.is_table() && std::ranges::find(keys_, name) == keys_.end()) {
        unknown_section(line_of(key), name);
      } else {
        read_key(name, line_of(key), node);
      }
    }
  }

  void fault(std::uint32_t line, std::string key, std::string message) {
    ++fault_count_;
    if (faults_.size() < kTomlFaultsMax) {
      faults_.push_back({std::string(file_), line, std::move(key), std::move(message)});
    }
  }

  std::expected<std::vector<TomlEntry>, std::vector<TextFault>> result() && {
    if (fault_count_ > faults_.size()) {
      const std::string more = std::to_string(fault_count_ - faults_.size());
      faults_.push_back({std::string(file_), 0, "", "and " + more + " more faults"});
    }
    std::ranges::stable_sort(faults_, {}, [](const TextFault& f) { return f.line == 0 ? UINT32_MAX : f.line; });
    if (!faults_.empty()) return std::unexpected(std::move(faults_));
    std::ranges::sort(entries_, {}, &TomlEntry::field);
    return std::move(entries_);
  }

 private:
  template <typename Source>
  static std::uint32_t line_of(const Source& source) {
    return static_cast<std::uint32_t>(source.source().begin.line);
  }

  void read_section(const std::string& section, const toml::table& table) {
    for (const auto& [key, node] : table) {
      read_key(section + '.' + std::string(key.str()), line_of(key), node);
    }
  }

  void unknown_section(std::uint32_t line, const std::string& name) {
    const std::string_view near = fault_count_ < kTomlFaultsMax ? nearest_word(name, sections_) : std::string_view{};
    std::string message = "unknown section";
    if (!near.empty()) {
      message += ", did you mean [" + std::string(near) + "]?";
    } else {
      message += "; known are";
      for (const std::string_view section : sections_) message += " [" + std::string(section) + "]";
    }
    fault(line, name, std::move(message));
  }

  void read_key(const std::string& key, std::uint32_t line, const toml::node& node) {
    const auto at = std::ranges::find(keys_, key);
    if (at == keys_.end()) {
      const std::string_view near = fault_count_ < kTomlFaultsMax ? nearest_word(key, keys_) : std::string_view{};
      fault(line, key, near.empty() ? "unknown key" : "unknown key, did you mean " + std::string(near) + "?");
      return;
    }
    const auto index = static_cast<std::size_t>(at - keys_.begin());
    if (std::optional<TomlValue> value = value_of(fields_[index], line, node)) {
      entries_.push_back({index, line, std::move(*value)});
    }
  }

  std::optional<TomlValue> value_of(const TomlField& field, std::uint32_t line, const toml::node& node) {
    switch (field.type) {
      case TomlType::kText:
        if (const auto* text = node.as_string()) return text_of(field, line, text->get());
        break;
      case TomlType::kWhole:
        if (const auto* whole = node.as_integer()) {
          const std::int64_t value = whole->get();
          if (!in_range(field, line, static_cast<double>(value), std::to_string(value))) return std::nullopt;
          return value;
        }
        break;
      case TomlType::kNumber:
        if (const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt) {
          if (!in_range(field, line, *value, format_number(*value))) return std::nullopt;
          return *value;
        }
        break;
      case TomlType::kFlag:
        if (const auto* flag = node.as_boolean()) return flag->get();
        break;
      case TomlType::kTextList:
        if (const auto* list = node.as_array()) return list_of(field, line, *list);
        break;
      case TomlType::kUnsigned:
        if (node.is_integer() || node.is_string()) return unsigned_of(field, line, node);
        break;
    }
    wrong_type(field, line, node);
    return std::nullopt;
  }

  void wrong_type(const TomlField& field, std::uint32_t line, const toml::node& node) {
    fault(line, std::string(field.key),
          "is " + std::string(name_of(node.type())) + ", wanted " + std::string(wanted(field.type)));
  }

  bool in_range(const TomlField& field, std::uint32_t line, double value, const std::string& shown) {
    if (value >= field.low && value <= field.high) return true;
    fault(line, std::string(field.key), shown + " is out of range, allowed " + range_text(field));
    return false;
  }

  std::optional<TomlValue> text_of(const TomlField& field, std::uint32_t line, const std::string& text) {
    const auto bytes = static_cast<double>(text.size());
    if (!in_range(field, line, bytes, "a length of " + std::to_string(text.size()) + " bytes")) return std::nullopt;
    return text;
  }

  std::optional<TomlValue> list_of(const TomlField& field, std::uint32_t line, const toml::array& list) {
    std::vector<std::string> out;
    for (const toml::node& node : list) {
      const auto* text = node.as_string();
      if (text == nullptr) return wrong_type(field, line, node), std::nullopt;
      out.push_back(text->get());
    }
    const auto entries = static_cast<double>(out.size());
    if (!in_range(field, line, entries, std::to_string(out.size()) + " entries")) return std::nullopt;
    return out;
  }

  std::optional<TomlValue> unsigned_of(const TomlField& field, std::uint32_t line, const toml::node& node) {
    std::uint64_t value = 0;
    if (const auto* whole = node.as_integer()) {
      if (whole->get() >= 0) return static_cast<std::uint64_t>(whole->get());
      return wrong_type(field, line, node), std::nullopt;
    }
    const std::string& text = node.as_string()->get();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) return value;
    fault(line, std::string(field.key), "is not a whole number from 0 to 18446744073709551615");
    return std::nullopt;
  }

  std::string_view file_;
  std::span<const TomlField> fields_;
  std::vector<std::string_view> keys_;
  std::vector<std::string_view> sections_;
  std::vector<TomlEntry> entries_;
  std::vector<TextFault> faults_;
  std::size_t fault_count_ = 0;
};

}  // namespace

std::string describe(const TextFault& fault) {
  std::string out = fault.file;
  if (fault.line != 0) out += ':' + std::to_string(fault.line);
  if (!out.empty()) out += ": ";
  if (!fault.key.empty()) out += fault.key + ": ";
  return out + fault.message;
}

std::string_view section_of(std::string_view key) {
  const std::size_t dot = key.find('.');
  return dot == std::string_view::npos ? std::string_view{} : key.substr(0, dot);
}

std::string format_number(double value) {
  // A double below 2^1024 has at most 309 digits before the point, and at most 1074 behind it.
  std::array<char, 1400> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

std::expected<std::vector<TomlEntry>, std::vector<TextFault>> read_toml(std::string_view text, std::string_view file,
                                                                        std::span<const TomlField> fields) {
  Reading reading(file, fields);
  if (text.size() > kTomlBytesMax) {
    reading.fault(0, "", "the file is longer than 1 MiB");
    return std::move(reading).result();
  }
  try {
    reading.read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    reading.fault(static_cast<std::uint32_t>(error.source().begin.line), "", std::string(error.description()));
  }
  return std::move(reading).result();
}

}  // namespace talus::protocol
