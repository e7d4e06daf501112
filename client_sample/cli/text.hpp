// Command line words <-> values. Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/grid/chunk_key.hpp"

namespace talus::cli {

/// "LOD/X/Y/Z", decimal, as in URLs; nothing for anything else, a key outside the world included.
std::optional<ChunkKey> parse_chunk_key(std::string_view text);
std::string format_chunk_key(const ChunkKey& key);

/// "x,y,z" in metres, each finite.
std::optional<glm::dvec3> parse_place(std::string_view text);
/// "a,b", each finite.
std::optional<glm::dvec2> parse_pair(std::string_view text);
/// "WxH", whole numbers from 1.
std::optional<glm::ivec2> parse_size(std::string_view text);

/// As a JSON string, with its quotes.
std::string json_string(std::string_view text);

}  // namespace talus::cli
