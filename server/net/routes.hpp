// From a request to what has to be done for it. Pure: every refusal that needs no work is decided here, in one place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "protocol/tileset.hpp"
#include "server/cache/payload.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/http_request.hpp"
#include "server/net/join_token.hpp"
#include "server/net/static_files.hpp"
#include "server/world/world.hpp"

namespace talus::server {

/// Answer at once.
struct AnswerRoute {
  HttpAnswer answer;
  std::optional<TokenFault> token_fault{};  ///< why, when it refuses a stranger
};
/// Answer with the payload, cacheable for ever.
struct ChunkRoute {
  PayloadName name;
};
/// Ask the pool where one can stand.
struct SpawnRoute {
  std::size_t world = 0;
  glm::dvec2 near_m{};
};
/// Ask the pool what the ground is.
struct PointsRoute {
  std::size_t world = 0;
  std::vector<glm::dvec2> places_m;
};
/// Ask the pool what a ray meets.
struct RayRoute {
  std::size_t world = 0;
  glm::dvec3 from_m{};
  glm::dvec3 direction{};  ///< of length 1
  double max_m = 0;
};
/// Ask the pool where the ground around a place ends, and describe it as 3D Tiles.
struct TilesetRoute {
  std::size_t world = 0;
  protocol::TilesetPlace place;  ///< with an origin
};
/// Become a stream of this world.
struct StreamRoute {
  std::size_t world = 0;
  bool is_admitted = false;  ///< else the hello must bring a token
};
/// Read the metrics; admin door only.
struct MetricsRoute {};

using Route =
    std::variant<AnswerRoute, ChunkRoute, SpawnRoute, PointsRoute, RayRoute, TilesetRoute, StreamRoute, MetricsRoute>;

enum class Door : std::uint8_t { kPublic, kAdmin };

struct RouteContext {
  const Worlds& worlds;
  const StaticFiles& files;
  const std::string& worlds_json;
  Door door = Door::kPublic;
  bool is_ready = true;               ///< false while starting and draining
  const TokenKeys* tokens = nullptr;  ///< of those who may read; without keys everybody may
  std::int64_t now_unix_s = 0;
};

Route resolve(const HttpRequest& request, const RouteContext& context);

/// Whether an If-None-Match value names `etag` (weak comparison, lists and `*`).
bool names_etag(std::string_view if_none_match, std::string_view etag);

}  // namespace talus::server
