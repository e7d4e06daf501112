// Routes of payloads: chunks, columns and strips by key and format. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/grid/chunk_key.hpp"
#include "server/net/routes.hpp"

namespace talus::server {

using Segments = std::span<const std::string_view>;

inline constexpr std::string_view kChunkShape = "chunk: expected chunks/{lod}/{x}/{y}/{z} and .drc, .glb or .density";

AnswerRoute bad_request(std::string_view code, std::string_view message);
AnswerRoute not_found(std::string_view code, std::string_view message);

/// Three numbers of `origin=`, each within what a chunk's corner can be; the refusal if they are not that.
std::optional<AnswerRoute> read_origin(std::string_view query, glm::dvec3& out);
/// A whole number of a path.
struct Coordinate {
  std::string_view name;
  std::int32_t low;
  std::int32_t high;
};
inline constexpr Coordinate kLod{"lod", 0, kLodMax};
inline constexpr Coordinate kX{"x", -kChunkLimit, kChunkLimit};
inline constexpr Coordinate kY{"y", -kChunkLimit, kChunkLimit};
inline constexpr Coordinate kZ{"z", -kChunkLimit, kChunkLimit};
/// The number, or the refusal that names it.
std::optional<AnswerRoute> read_coordinate(const Coordinate& coordinate, std::string_view text, std::int32_t& out);
/// A payload of a world that exists, or 304 without work.
Route payload_route(const HttpRequest& request, const RouteContext& context, const PayloadName& name);
/// `parts` are what follows `chunks/`: lod, x, y, z, where the last also carries the format.
Route chunk_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts);
/// `parts` are what follows `seams/`: lod, x, y, z, face.drc.
Route seam_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts);
/// `parts` are what follows `columns/`: lod, x, z.height.
Route column_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts);

}  // namespace talus::server
