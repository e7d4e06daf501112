#include "server/net/payload_routes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/grid/chunk_face.hpp"
#include "core/grid/chunk_key.hpp"
#include "server/net/url_text.hpp"

namespace talus::server {

namespace {

struct NamedFormat {
  std::string_view suffix;
  PayloadFormat format;
};
constexpr std::array<NamedFormat, 4> kChunkFormats{{
    {".drc", PayloadFormat::kDraco},
    {".mesh", PayloadFormat::kMeshopt},
    {".glb", PayloadFormat::kGlb},
    {".density", PayloadFormat::kDensity},
}};

/// A revision says which bytes the client knows of; every chunk is as its world made it, so any revision is current.
std::optional<AnswerRoute> read_revision(std::string_view query) {
  const QueryValue value = query_value(query, "rev");
  if (value.state == QueryState::kAbsent) return std::nullopt;
  const auto revision = whole_number(value.value);
  if (value.state == QueryState::kPresent && revision && *revision >= 0) return std::nullopt;
  return bad_request("bad_rev", "rev: expected the revision of a chunk, a whole number from 0");
}

}  // namespace

AnswerRoute bad_request(std::string_view code, std::string_view message) {
  return {error_answer(400, code, message)};
}

AnswerRoute not_found(std::string_view code, std::string_view message) {
  return {error_answer(404, code, message)};
}

std::optional<AnswerRoute> read_origin(std::string_view query, glm::dvec3& out) {
  constexpr double kOriginMax = 1.0e12;
  const QueryValue value = query_value(query, "origin");
  if (value.state == QueryState::kAbsent) return std::nullopt;
  const auto numbers = decimal_numbers(value.value, 3);
  const auto inside = [](double v) { return std::abs(v) <= kOriginMax; };
  if (value.state != QueryState::kPresent || !numbers || !std::all_of(numbers->begin(), numbers->end(), inside)) {
    return bad_request("bad_origin", "origin: expected x,y,z in metres, each within +-1e12");
  }
  out = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return std::nullopt;
}

std::optional<AnswerRoute> read_coordinate(const Coordinate& coordinate, std::string_view text, std::int32_t& out) {
  const auto& [name, low, high] = coordinate;
  const auto value = whole_number(text);
  if (!value || *value < low || *value > high) {
    return bad_request(fmt::format("bad_{}", name),
                       fmt::format("{}: expected a whole number from {} to {}", name, low, high));
  }
  out = *value;
  return std::nullopt;
}

Route payload_route(const HttpRequest& request, const RouteContext& context, const PayloadName& name) {
  if (auto refused = read_revision(request.query)) return std::move(*refused);
  const std::string& etag = context.worlds[name.world]->etag(name);
  if (!names_etag(request.field("if-none-match").value_or(""), etag)) return ChunkRoute{name};
  HttpAnswer answer;
  answer.status = 304;
  answer.etag = etag;
  answer.cache_control = kImmutable;
  return AnswerRoute{std::move(answer)};
}

Route chunk_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts) {
  if (parts.size() != 4) return bad_request("bad_chunk", kChunkShape);
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world);
  std::string_view z = parts[3];
  const auto* const found = std::ranges::find_if(kChunkFormats, [&](const auto& f) { return z.ends_with(f.suffix); });
  if (found == kChunkFormats.end()) {
    return bad_request("bad_format", "format: a chunk ends in .drc, .mesh, .glb or .density");
  }
  name.format = found->format;
  z.remove_suffix(found->suffix.size());
  if (auto refused = read_coordinate(kLod, parts[0], name.key.lod)) return std::move(*refused);
  if (auto refused = read_coordinate(kX, parts[1], name.key.x)) return std::move(*refused);
  if (auto refused = read_coordinate(kY, parts[2], name.key.y)) return std::move(*refused);
  if (auto refused = read_coordinate(kZ, z, name.key.z)) return std::move(*refused);
  if (has_origin(name.format)) {
    if (auto refused = read_origin(request.query, name.origin)) return std::move(*refused);
  }
  return payload_route(request, context, name);
}

Route seam_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts) {
  if (parts.size() != 5) return bad_request("bad_seam", "seam: expected seams/{lod}/{x}/{y}/{z}/{face}.drc");
  const std::size_t dot = std::min(parts[4].find('.'), parts[4].size());
  const MeshFormat* const format = mesh_format_named(parts[4].substr(std::min(dot + 1, parts[4].size())));
  if (format == nullptr) return bad_request("bad_format", "format: a seam strip ends in .drc or .mesh");
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world);
  name.format = format->strip;
  if (auto refused = read_coordinate(kLod, parts[0], name.key.lod)) return std::move(*refused);
  if (auto refused = read_coordinate(kX, parts[1], name.key.x)) return std::move(*refused);
  if (auto refused = read_coordinate(kY, parts[2], name.key.y)) return std::move(*refused);
  if (auto refused = read_coordinate(kZ, parts[3], name.key.z)) return std::move(*refused);
  const auto face = face_named(parts[4].substr(0, dot));
  if (!face) return bad_request("bad_face", "face: expected one of px nx py ny pz nz");
  name.face = *face;
  return payload_route(request, context, name);
}

Route column_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts) {
  constexpr std::string_view kSuffix = ".height";
  if (parts.size() != 3) return bad_request("bad_column", "column: expected columns/{lod}/{x}/{z}.height");
  if (!parts[2].ends_with(kSuffix)) return bad_request("bad_format", "format: a column ends in .height");
  PayloadName name;
  name.world = static_cast<std::uint32_t>(world);
  name.format = PayloadFormat::kHeight;
  const std::string_view z = parts[2].substr(0, parts[2].size() - kSuffix.size());
  if (auto refused = read_coordinate(kLod, parts[0], name.key.lod)) return std::move(*refused);
  if (auto refused = read_coordinate(kX, parts[1], name.key.x)) return std::move(*refused);
  if (auto refused = read_coordinate(kZ, z, name.key.z)) return std::move(*refused);
  return payload_route(request, context, name);
}

}  // namespace talus::server
