// What a client needs to know of a world, out of GET /v1/worlds/{world}. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/world/manifest.hpp"
#include "protocol/interest_area.hpp"

namespace talus::client {

struct WorldInfo {
  std::string name;
  std::string world_hash;
  std::string seed;
  std::uint32_t generator_version = 0;
  protocol::WorldShape shape;
  double sea_level_m = 0.0;
  int lod_max = 0;
  std::string manifest_json;  ///< the whole of it
};

/// Nothing unless every field is there, of its type and within the limits of the protocol.
std::optional<WorldInfo> parse_world_info(std::string_view manifest_json);

/// The world itself, to be evaluated here (core/world, core/mesh). Nothing when this build would not give the server's
/// chunks: another generator version, or parameters it does not know.
std::optional<Manifest> manifest_of(const WorldInfo& info);

/// `height_m` of each place in the answer of GET /v1/worlds/{world}/points; empty unless all are there.
std::vector<double> parse_heights(std::string_view json);

/// The place in the answer of GET /v1/worlds/{world}/spawn.
std::optional<glm::dvec3> parse_spawn(std::string_view json);

/// `message` of an error body, or the body itself, shortened, when it is none.
std::string error_text(std::string_view body);

}  // namespace talus::client
