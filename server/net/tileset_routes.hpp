// Routes of 3D Tiles: the tileset, its subtrees, its content. Pure.
#pragma once

#include <cstddef>

#include "server/net/payload_routes.hpp"

namespace talus::server {

/// `parts` are what follows `3dtiles/`: tileset.json, or the root of a tree (`world`, or lod, x, z of a column), then
/// level, x and y of a tile, where the last also says .glb or .subtree.
Route tileset_route(const HttpRequest& request, const RouteContext& context, std::size_t world, Segments parts);

/// The answer of a TilesetRoute.
HttpAnswer tileset_answer(const World& world, const protocol::TilesetPlace& place);

}  // namespace talus::server
