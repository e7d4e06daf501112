#include "server/net/routes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "core/grid/chunk_key.hpp"
#include "core/map/map_tile.hpp"
#include "server/net/payload_routes.hpp"
#include "server/net/tileset_routes.hpp"
#include "server/net/url_text.hpp"
#include "server/world/place_query.hpp"

namespace talus::server {

namespace {

constexpr std::size_t kSegmentsMax = 12;

constexpr std::string_view kAllowReads = "Allow: GET, HEAD, OPTIONS\r\n";
constexpr std::string_view kPreflight =
    "Allow: GET, HEAD, OPTIONS\r\nAccess-Control-Allow-Methods: GET, HEAD, OPTIONS\r\n"
    "Access-Control-Allow-Headers: Authorization, If-None-Match, Content-Type, X-Request-Id\r\nAccess-Control-Max-Age: "
    "86400\r\n";

AnswerRoute text_answer(int status, std::string_view text) {
  HttpAnswer answer;
  answer.status = status;
  answer.content_type = "text/plain; charset=utf-8";
  answer.cache_control = "no-store";
  answer.text = text;
  return {std::move(answer)};
}

AnswerRoute cacheable_json(const HttpRequest& request, const std::string& body, const std::string& etag) {
  HttpAnswer answer;
  if (names_etag(request.field("if-none-match").value_or(""), etag)) {
    answer.status = 304;
  } else {
    answer = json_answer(body);
  }
  answer.etag = etag;
  answer.cache_control = kNoCache;
  return {std::move(answer)};
}

/// What the map is to show: layer=, or the shaded relief.
std::optional<AnswerRoute> read_layer(std::string_view query, MapLayer& out) {
  const QueryValue value = query_value(query, "layer");
  if (value.state == QueryState::kAbsent) return std::nullopt;
  const auto layer = value.state == QueryState::kPresent ? map_layer(value.value) : std::nullopt;
  if (!layer)
    return bad_request("bad_layer", fmt::format("layer: expected one of {}", fmt::join(kMapLayerNames, ", ")));
  out = *layer;
  return std::nullopt;
}

/// zoom, x, y.png.
Route map_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts) {
  constexpr std::array<std::string_view, 3> kNames{"zoom", "x", "y"};
  if (parts.size() != kNames.size() || !parts[2].ends_with(".png")) {
    return bad_request("bad_map", "map: expected map/{zoom}/{x}/{y}.png");
  }
  std::array<std::string_view, 3> texts{parts[0], parts[1], parts[2]};
  texts[2].remove_suffix(4);
  std::array<std::int32_t, 3> values{};
  const int cells = context.worlds[world]->function().cells();
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const std::int32_t limit = i == 0 ? 0 : map_tile_limit(values[0], cells);
    const std::int32_t high = i == 0 ? kMapZoomMax : limit - 1;
    if (auto refused = read_coordinate({kNames[i], -limit, high}, texts[i], values[i])) return std::move(*refused);
  }
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world);
  name.format = PayloadFormat::kMap;
  name.key = {values[0], values[1], 0, values[2]};
  if (auto refused = read_layer(request.query, name.layer)) return std::move(*refused);
  return payload_route(request, context, name);
}

std::optional<glm::dvec2> read_place(std::string_view text, const WorldFunction& world) {
  const auto numbers = decimal_numbers(text, 2);
  const double limit = place_limit_m(world);
  if (!numbers || std::abs((*numbers)[0]) > limit || std::abs((*numbers)[1]) > limit) return std::nullopt;
  return glm::dvec2{(*numbers)[0], (*numbers)[1]};
}

Route spawn_route(const HttpRequest& request, const RouteContext& context, std::size_t world) {
  const WorldFunction& function = context.worlds[world]->function();
  const QueryValue value = query_value(request.query, "near");
  if (value.state == QueryState::kAbsent) return SpawnRoute{world, {}};
  const auto place = read_place(value.value, function);
  if (value.state != QueryState::kPresent || !place) {
    return bad_request("bad_near",
                       fmt::format("near: expected x,z in metres, each within +-{}", place_limit_m(function)));
  }
  return SpawnRoute{world, *place};
}

Route points_route(const HttpRequest& request, const RouteContext& context, std::size_t world) {
  const WorldFunction& function = context.worlds[world]->function();
  const QueryValue value = query_value(request.query, "xz");
  PointsRoute route{world, {}};
  std::string_view rest = value.value;
  bool is_good = value.state == QueryState::kPresent;
  while (is_good) {
    const std::size_t end = rest.find(';');
    const auto place = read_place(rest.substr(0, end), function);
    is_good = place && route.places_m.size() < kPointsMax;
    if (is_good) route.places_m.push_back(*place);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (!is_good) {
    return bad_request("bad_xz", fmt::format("xz: expected 1 to {} places as x,z;x,z in metres, each within +-{}",
                                             kPointsMax, place_limit_m(function)));
  }
  return route;
}

/// Three finite numbers, each within `limit`.
std::optional<glm::dvec3> read_vector(const HttpRequest& request, std::string_view name, double limit) {
  const QueryValue value = query_value(request.query, name);
  const auto numbers = value.state == QueryState::kPresent ? decimal_numbers(value.value, 3) : std::nullopt;
  const auto inside = [&](double v) { return std::abs(v) <= limit; };
  if (!numbers || !std::ranges::all_of(*numbers, inside)) return std::nullopt;
  return glm::dvec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

Route ray_route(const HttpRequest& request, const RouteContext& context, std::size_t world) {
  const WorldFunction& function = context.worlds[world]->function();
  const double place_max = place_limit_m(function);
  const double ray_max = ray_limit_m(function);
  RayRoute route{world, {}, {}, ray_max};
  const auto from = read_vector(request, "from", place_max);
  if (!from) return bad_request("bad_from", fmt::format("from: expected x,y,z in metres, each within +-{}", place_max));
  const auto direction = read_vector(request, "dir", 1e6);
  const double length = direction ? glm::length(*direction) : 0.0;
  if (length < 1e-6) {
    return bad_request("bad_dir", "dir: expected x,y,z of a direction, each within +-1e6, longer than 1e-6");
  }
  if (const QueryValue value = query_value(request.query, "max"); value.state != QueryState::kAbsent) {
    const auto max = value.state == QueryState::kPresent ? decimal_number(value.value) : std::nullopt;
    if (!max || !(*max > 0) || *max > ray_max) {
      return bad_request("bad_max", fmt::format("max: expected metres above 0, up to {}", ray_max));
    }
    route.max_m = *max;
  }
  route.from_m = *from;
  route.direction = *direction / length;
  return route;
}

/// The token a request brings, in its head or, for those who cannot write one, in its query.
std::string token_of(const HttpRequest& request) {
  constexpr std::string_view kBearer = "bearer ";
  const std::string_view field = request.field("authorization").value_or("");
  if (field.size() > kBearer.size() && equal_ignoring_case(field.substr(0, kBearer.size()), kBearer)) {
    return std::string(field.substr(kBearer.size()));
  }
  return query_value(request.query, "token").value;
}

AnswerRoute refuse_stranger(TokenFault fault) {
  const bool is_elsewhere = fault == TokenFault::kOtherWorld;
  const std::string_view challenge = fault == TokenFault::kMissing ? "WWW-Authenticate: Bearer realm=\"talus\"\r\n"
                                     : is_elsewhere
                                         ? "WWW-Authenticate: Bearer realm=\"talus\", error=\"insufficient_scope\"\r\n"
                                         : "WWW-Authenticate: Bearer realm=\"talus\", error=\"invalid_token\"\r\n";
  const std::string_view code = fault == TokenFault::kMissing ? "token_missing" : "token_refused";
  return {error_answer(is_elsewhere ? 403 : 401, code, describe(fault), challenge), fault};
}

Route world_route(const HttpRequest& request, const RouteContext& context, Segments parts) {
  const std::size_t world = world_index(context.worlds, parts[0]);
  if (world == context.worlds.size()) return not_found("unknown_world", "there is no world of that name here");
  // Who only asks which methods there are brings no token (CORS).
  const bool is_guarded =
      context.tokens != nullptr && !context.tokens->empty() && request.method != HttpMethod::kOptions;
  const bool is_stream = parts.size() == 2 && parts[1] == "stream";
  bool is_admitted = true;
  if (is_guarded) {
    const std::string token = token_of(request);
    is_admitted = !token.empty();
    const auto fault = context.tokens->fault_of(token, parts[0], context.now_unix_s);
    if (fault && (is_admitted || !is_stream)) return refuse_stranger(*fault);
  }
  if (is_stream) return StreamRoute{world, is_admitted};
  if (parts.size() == 1) {
    const World& found = *context.worlds[world];
    return cacheable_json(request, found.manifest_json(), found.manifest_etag());
  }
  if (parts[1] == "chunks") return chunk_route(request, context, world, parts.subspan(2));
  if (parts[1] == "seams") return seam_route(request, context, world, parts.subspan(2));
  if (parts[1] == "3dtiles") return tileset_route(request, context, world, parts.subspan(2));
  if (parts[1] == "columns") return column_route(request, context, world, parts.subspan(2));
  if (parts[1] == "map") return map_route(request, context, world, parts.subspan(2));
  if (parts.size() == 2 && parts[1] == "spawn") return spawn_route(request, context, world);
  if (parts.size() == 2 && parts[1] == "points") return points_route(request, context, world);
  if (parts.size() == 2 && parts[1] == "ray") return ray_route(request, context, world);
  return not_found("unknown_route", "there is nothing of that name in a world");
}

AnswerRoute file_route(const HttpRequest& request, const RouteContext& context) {
  const StaticFileRef file = context.files.find(request.path);
  if (file == nullptr) {
    if (request.path == "/" && context.files.size() == 0) {
      return not_found("no_viewer", "this server was started without --viewer; the doors are below /v1/worlds");
    }
    return not_found("unknown_route", "there is nothing of that name here");
  }
  HttpAnswer answer;
  answer.etag = file->etag;
  answer.cache_control = file->is_immutable ? kImmutable : kNoCache;
  if (names_etag(request.field("if-none-match").value_or(""), file->etag)) {
    answer.status = 304;
  } else {
    answer.content_type = file->content_type;
    answer.file = file;
  }
  return {std::move(answer)};
}

/// What is there, whatever the method.
Route resolve_path(const HttpRequest& request, const RouteContext& context) {
  if (request.path == "/healthz") return text_answer(200, "ok\n");
  if (request.path == "/readyz") {
    return context.is_ready ? text_answer(200, "ok\n") : text_answer(503, "not ready\n");
  }
  if (context.door == Door::kAdmin) {
    if (request.path == "/metrics") return MetricsRoute{};
    return not_found("unknown_route", "there is nothing of that name here");
  }
  std::array<std::string_view, kSegmentsMax> parts;
  const auto count = split_path(request.path, parts);
  const bool is_v1 = parts[1] == "v1";  // parts[0] is empty: a path starts with a slash
  if (!is_v1) return file_route(request, context);
  if (count && *count >= 3 && parts[2] == "worlds") {
    if (*count == 3) return AnswerRoute{json_answer(context.worlds_json)};
    return world_route(request, context, Segments(parts).subspan(3, *count - 3));
  }
  if (!count && parts[2] == "worlds" && parts[4] == "chunks") {
    return bad_request("bad_chunk", kChunkShape);
  }
  return not_found("unknown_route", "there is nothing of that name here");
}

}  // namespace

bool names_etag(std::string_view if_none_match, std::string_view etag) {
  while (!if_none_match.empty()) {
    const std::size_t comma = if_none_match.find(',');
    std::string_view one = if_none_match.substr(0, comma);
    if_none_match = comma == std::string_view::npos ? std::string_view{} : if_none_match.substr(comma + 1);
    while (one.starts_with(' ') || one.starts_with('\t')) one.remove_prefix(1);
    while (one.ends_with(' ') || one.ends_with('\t')) one.remove_suffix(1);
    if (one.starts_with("W/")) one.remove_prefix(2);
    if (one == etag || one == "*") return true;
  }
  return false;
}

Route resolve(const HttpRequest& request, const RouteContext& context) {
  if (request.path.empty()) {  // OPTIONS *
    HttpAnswer answer;
    answer.status = 204;
    answer.fields = kPreflight;
    return AnswerRoute{std::move(answer)};
  }
  Route route = resolve_path(request, context);
  const auto* answered = std::get_if<AnswerRoute>(&route);
  if (answered != nullptr && answered->answer.status == 404) return route;
  if (request.method == HttpMethod::kOptions) {
    HttpAnswer answer;
    answer.status = 204;
    answer.fields = kPreflight;
    return AnswerRoute{std::move(answer)};
  }
  if (request.method == HttpMethod::kOther) {
    return AnswerRoute{error_answer(405, "method_not_allowed", "this route is only read", kAllowReads)};
  }
  if (request.has_body) return bad_request("unexpected_body", "body: this route takes none");
  return route;
}

}  // namespace talus::server
