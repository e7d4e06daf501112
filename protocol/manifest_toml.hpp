// A manifest's TOML text <-> its values, and the hash that names its world.
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "core/world/manifest.hpp"
#include "protocol/toml_reader.hpp"

namespace talus::protocol {

/// Reads and validates. Every fault is reported: unknown keys with the nearest known one, wrong types, values out of
/// range with the allowed range, contradictions. `file` only labels faults. Texts over 1 MiB are refused.
std::expected<Manifest, std::vector<TextFault>> parse_manifest(std::string_view text, std::string_view file);

/// A complete TOML file with every parameter, its unit, limits and meaning as comments. parse_manifest gives `manifest`
/// back.
std::string format_manifest(const Manifest& manifest);

/// The part of format_manifest(manifest) that sets one parameter ("erosion.gain") or one section ("erosion"); empty
/// when there is none of that name.
std::string format_parameters(const Manifest& manifest, std::string_view name);

/// The parameter or section that `name` was probably meant to be; empty when none is near.
std::string_view nearest_parameter(std::string_view name);

/// 64 hexadecimal digits: SHA-256 of canonical_bytes(manifest).
std::string world_hash(const Manifest& manifest);

/// The body of GET /v1/worlds/{world}. `seed` is a text: clients whose numbers are doubles would lose bits above 2^53.
/// `height_range_m` is WorldFunction::height_range_m() of this manifest.
std::string manifest_json(const Manifest& manifest);

}  // namespace talus::protocol
