#include "server/net/tileset_routes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "protocol/tileset.hpp"
#include "server/net/url_text.hpp"
#include "server/world/column_heights.hpp"
#include "server/world/place_query.hpp"

namespace talus::server {

namespace {

using protocol::TileId;
using protocol::TileTree;

constexpr std::string_view kShape =
    "3dtiles: expected tileset.json, or world or lod/x/z, then level/x/y and .glb or .subtree";

/// Numbers of the query value `name`, each within its limit; absent gives nothing and no refusal.
struct QueryNumbers {
  std::optional<std::vector<double>> numbers;
  bool is_refused = false;
};
QueryNumbers read_numbers(std::string_view query, std::string_view name, std::size_t count) {
  const QueryValue value = query_value(query, name);
  if (value.state == QueryState::kAbsent) return {};
  if (value.state != QueryState::kPresent) return {std::nullopt, true};
  auto numbers = decimal_numbers(value.value, count);
  const bool is_refused = !numbers;
  return {std::move(numbers), is_refused};
}

/// origin=x,z and km=: the place of a local frame.
std::optional<AnswerRoute> read_square(std::string_view query, const WorldFunction& world,
                                       protocol::TilesetPlace& out) {
  const double limit = place_limit_m(world);
  const QueryNumbers origin = read_numbers(query, "origin", 2);
  const auto is_far = [&](const std::vector<double>& at) { return std::max(std::abs(at[0]), std::abs(at[1])) > limit; };
  if (origin.is_refused || (origin.numbers && is_far(*origin.numbers))) {
    return bad_request("bad_origin", fmt::format("origin: expected x,z in metres, each within +-{}", limit));
  }
  if (origin.numbers) out.origin_m = {(*origin.numbers)[0], (*origin.numbers)[1]};
  const QueryNumbers km = read_numbers(query, "km", 1);
  const bool is_outside = km.numbers && !((*km.numbers)[0] > 0 && (*km.numbers)[0] <= protocol::kTilesetKmMax);
  if (km.is_refused || is_outside || (km.numbers && !origin.numbers)) {
    return bad_request("bad_km", fmt::format("km: expected kilometres above 0 and up to {}, beside an origin",
                                             protocol::kTilesetKmMax));
  }
  if (km.numbers) out.km = (*km.numbers)[0];
  return std::nullopt;
}

/// lat= and lon=: where the frame touches the globe.
std::optional<AnswerRoute> read_globe(std::string_view query, protocol::TilesetPlace& out) {
  const QueryNumbers latitude = read_numbers(query, "lat", 1);
  const QueryNumbers longitude = read_numbers(query, "lon", 1);
  const bool is_alone = latitude.numbers.has_value() != longitude.numbers.has_value();
  if (latitude.is_refused || (latitude.numbers && std::abs((*latitude.numbers)[0]) > 90) ||
      (is_alone && !latitude.numbers)) {
    return bad_request("bad_lat", "lat: expected degrees from -90 to 90, beside lon");
  }
  if (longitude.is_refused || (longitude.numbers && std::abs((*longitude.numbers)[0]) > 180) || is_alone) {
    return bad_request("bad_lon", "lon: expected degrees from -180 to 180, beside lat");
  }
  if (latitude.numbers) out.latitude_longitude_deg = {(*latitude.numbers)[0], (*longitude.numbers)[0]};
  return std::nullopt;
}

/// A described document: cheap to make, so it is revalidated rather than kept.
HttpAnswer described(const World& world, std::string_view type, std::string body) {
  HttpAnswer answer;
  answer.content_type = type;
  answer.text = std::move(body);
  answer.etag = world.tileset_etag();
  answer.cache_control = kNoCache;
  return answer;
}

/// 304 for whoever holds the document already.
std::optional<AnswerRoute> unchanged(const HttpRequest& request, const World& world) {
  if (!names_etag(request.field("if-none-match").value_or(""), world.tileset_etag())) return std::nullopt;
  HttpAnswer answer;
  answer.status = 304;
  answer.etag = world.tileset_etag();
  answer.cache_control = kNoCache;
  return AnswerRoute{std::move(answer)};
}

Route document_route(const HttpRequest& request, const RouteContext& context, std::size_t world) {
  protocol::TilesetPlace place;
  const World& of = *context.worlds[world];
  if (auto refused = read_square(request.query, of.function(), place)) return std::move(*refused);
  if (auto refused = read_globe(request.query, place)) return std::move(*refused);
  if (auto answer = unchanged(request, of)) return std::move(*answer);
  if (!place.origin_m) return AnswerRoute{tileset_answer(of, place)};
  return TilesetRoute{world, place};
}

std::optional<AnswerRoute> read_tree(Segments parts, TileTree& out) {
  if (parts.size() == 1) {
    if (parts[0] != "world") return bad_request("bad_tile", kShape);
    out = protocol::world_tree();
    return std::nullopt;
  }
  ChunkKey column;
  if (auto refused = read_coordinate(kLod, parts[0], column.lod)) return refused;
  if (auto refused = read_coordinate(kX, parts[1], column.x)) return refused;
  if (auto refused = read_coordinate(kZ, parts[2], column.z)) return refused;
  out = protocol::column_tree(column.lod, column.x, column.z);
  return std::nullopt;
}

/// Levels and coordinates of tiles that no tree has are unknown rather than malformed: engines follow availability.
std::optional<AnswerRoute> read_tile(Segments parts, std::string_view suffix, TileId& out) {
  const auto level = whole_number(parts[0]);
  const auto x = whole_number(parts[1]);
  const auto y = whole_number(parts[2].substr(0, parts[2].size() - suffix.size()));
  if (!level || !x || !y || *level < 0 || *x < 0 || *y < 0) return bad_request("bad_tile", kShape);
  out = {*level, static_cast<std::uint32_t>(*x), static_cast<std::uint32_t>(*y)};
  return std::nullopt;
}

Route content_route(const HttpRequest& request, const RouteContext& context, std::size_t world, const TileTree& tree,
                    const TileId& tile) {
  const auto column = protocol::column_of(tree, tile);
  if (!column) return not_found("unknown_tile", "this tree has no content there");
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world);
  name.format = PayloadFormat::kTile;
  name.key = *column;
  if (auto refused = read_origin(request.query, name.origin)) return std::move(*refused);
  return payload_route(request, context, name);
}

}  // namespace

Route tileset_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts) {
  const World& of = *context.worlds[world];
  if (parts.size() == 1 && parts[0] == "tileset.json") return document_route(request, context, world);
  if (parts.size() != 4 && parts.size() != 6) return not_found("unknown_route", kShape);
  const std::string_view last = parts.back();
  const std::string_view suffix = last.ends_with(".subtree") ? ".subtree" : ".glb";
  if (!last.ends_with(suffix)) return bad_request("bad_format", "format: a tile ends in .glb, a subtree in .subtree");
  TileTree tree;
  TileId tile;
  if (auto refused = read_tree(parts.first(parts.size() - 3), tree)) return std::move(*refused);
  if (auto refused = read_tile(parts.last(3), suffix, tile)) return std::move(*refused);
  if (suffix == ".glb") return content_route(request, context, world, tree, tile);
  if (!protocol::has_subtree(tree, tile)) return not_found("unknown_subtree", "no subtree of this tree begins there");
  if (auto answer = unchanged(request, of)) return std::move(*answer);
  const std::vector<std::byte> bytes = protocol::encode_subtree(tree, tile.level);
  return AnswerRoute{
      described(of, "application/octet-stream", {reinterpret_cast<const char*>(bytes.data()), bytes.size()})};
}

HttpAnswer tileset_answer(const World& world, const protocol::TilesetPlace& place) {
  std::vector<glm::dvec2> heights_m;
  if (place.origin_m) heights_m = column_heights(world.function(), protocol::tileset_columns(world.shape(), place));
  return described(world, "application/json", protocol::encode_tileset(world.shape(), place, heights_m));
}

}  // namespace talus::server
