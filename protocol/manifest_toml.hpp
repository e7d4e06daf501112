// A manifest's TOML text <-> its values, and the hash that names its world.
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "core/world/manifest.hpp"

namespace talus::protocol {

/// One thing wrong with a text, ready to print: "worlds/alps.toml:12: erosion.gain: 3 is out of range, allowed 0..1".
struct TextFault {
  std::string file;
  std::uint32_t line = 0;  ///< from 1; 0 when the fault has no place
  std::string key;
  std::string message;
};
std::string describe(const TextFault& fault);

/// Reads and validates. Every fault is reported: unknown keys with the nearest known one, wrong types, values out of
/// range with the allowed range, contradictions. `file` only labels faults. Texts over 1 MiB are refused.
std::expected<Manifest, std::vector<TextFault>> parse_manifest(std::string_view text, std::string_view file);

/// A complete TOML file with every parameter, its unit, limits and meaning as comments. parse_manifest gives `manifest`
/// back.
std::string format_manifest(const Manifest& manifest);

/// 64 hexadecimal digits: SHA-256 of canonical_bytes(manifest).
std::string world_hash(const Manifest& manifest);

/// The body of GET /v1/worlds/{world}.
std::string manifest_json(const Manifest& manifest);

}  // namespace talus::protocol
