#include "protocol/manifest_toml.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <openssl/evp.h>

#include "core/base/check.hpp"

namespace talus::protocol {
namespace {

/// The keys of a manifest: name and seed, then every parameter in canonical order.
enum FieldIndex : std::size_t { kName, kSeed, kFirstParameter };

std::vector<TomlField> manifest_fields() {
  std::vector<TomlField> fields{{"name", TomlType::kText, 1, static_cast<double>(kWorldNameMax)},
                                {"seed", TomlType::kUnsigned, 0, 0}};
  for (const ParameterInfo& info : manifest_parameters()) {
    fields.push_back({info.name, info.whole ? TomlType::kWhole : TomlType::kNumber, info.low, info.high});
  }
  return fields;
}

std::string_view key_of(std::string_view name) {
  return name.substr(name.find('.') + 1);
}

}  // namespace

std::expected<Manifest, std::vector<TextFault>> parse_manifest(std::string_view text, std::string_view file) {
  const std::vector<TomlField> fields = manifest_fields();
  auto entries = read_toml(text, file, fields);
  if (!entries) return std::unexpected(std::move(entries.error()));

  Manifest manifest;
  std::vector<std::uint32_t> lines(fields.size(), 0);
  for (TomlEntry& entry : *entries) {
    lines[entry.field] = entry.line;
    if (entry.field == kName) {
      manifest.name = std::move(std::get<std::string>(entry.value));
    } else if (entry.field == kSeed) {
      manifest.seed = std::get<std::uint64_t>(entry.value);
    } else if (const auto* whole = std::get_if<std::int64_t>(&entry.value)) {
      manifest.values[entry.field - kFirstParameter] = static_cast<double>(*whole);
    } else {
      manifest.values[entry.field - kFirstParameter] = std::get<double>(entry.value);
    }
  }

  std::vector<TextFault> faults;
  for (ManifestFault& fault : manifest_faults(manifest)) {
    const auto at = std::ranges::find(fields, fault.parameter, &TomlField::key);
    const std::uint32_t line = at == fields.end() ? 0 : lines[static_cast<std::size_t>(at - fields.begin())];
    faults.push_back({std::string(file), line, std::move(fault.parameter), std::move(fault.message)});
  }
  if (!faults.empty()) return std::unexpected(std::move(faults));
  return manifest;
}

std::string format_manifest(const Manifest& manifest) {
  std::string out = "# A talus world. Keys that are left out have their defaults; any change makes another world.\n\n";
  out += "# 1 to 32 characters of a-z, 0-9, _ and -; names the world in URLs.\n";
  out += "name = \"" + manifest.name + "\"\n";
  out += "# 0 to 18446744073709551615; in quotes above 9223372036854775807, where TOML's whole numbers end.\n";
  const bool quoted = manifest.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const std::string seed = std::to_string(manifest.seed);
  out += "seed = " + (quoted ? '"' + seed + '"' : seed) + "\n";
  std::string_view section;
  for (const ParameterInfo& info : manifest_parameters()) {
    if (section_of(info.name) == section) continue;
    section = section_of(info.name);
    out += "\n" + format_parameters(manifest, section);
  }
  return out;
}

std::string format_parameters(const Manifest& manifest, std::string_view name) {
  const std::span<const ParameterInfo> parameters = manifest_parameters();
  TALUS_CHECK(manifest.values.size() == parameters.size());
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterInfo& info = parameters[i];
    if (info.name != name && section_of(info.name) != name) continue;
    if (out.empty()) out += "[" + std::string(section_of(info.name)) + "]\n";
    out += "# " + std::string(info.meaning) + "\n# " + format_number(info.low) + ".." + format_number(info.high);
    if (!info.unit.empty()) out += " " + std::string(info.unit);
    if (info.whole) out += ", whole";
    out += ", default " + format_number(info.initial) + "\n";
    out += std::string(key_of(info.name)) + " = " + format_number(manifest.values[i]) + "\n";
  }
  return out;
}

std::string_view nearest_parameter(std::string_view name) {
  std::vector<std::string_view> names;
  for (const ParameterInfo& info : manifest_parameters()) {
    names.push_back(info.name);
    names.push_back(section_of(info.name));
  }
  return nearest_word(name, names);
}

std::string world_hash(const Manifest& manifest) {
  const std::vector<std::byte> bytes = canonical_bytes(manifest);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  TALUS_CHECK(EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) == 1);
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (unsigned int i = 0; i < size; ++i) {
    out += kDigits[digest[i] >> 4];
    out += kDigits[digest[i] & 15U];
  }
  return out;
}

}  // namespace talus::protocol
