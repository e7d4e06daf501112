#include "server/world/world.hpp"

#include <algorithm>
#include <utility>

#include "protocol/manifest_toml.hpp"
#include "server/observe/json.hpp"

namespace talus::server {

namespace {

/// Raised when the bytes of a format change for one and the same mesh.
/// By format; a map's is raised when maps look different.
constexpr std::array<std::string_view, kPayloadFormats> kEditions{"drc2",  "glb3",  "density1", "height1",  "map1",
                                                                  "seam2", "tile4", "mesh1",    "meshseam1"};
constexpr std::string_view kManifestEdition = "man2";
constexpr std::string_view kTilesetEdition = "tileset2";
/// Edits are not kept yet: every chunk is as its world made it.
constexpr std::string_view kRevision = "0";

std::string etag_of(std::string_view hash, std::string_view edition) {
  std::string out = "\"";
  out.append(hash.substr(0, 32)).append(".").append(kRevision).append(".").append(edition).append("\"");
  return out;
}

}  // namespace

World::World(Manifest manifest)
    : function_(std::move(manifest)),
      hash_(protocol::world_hash(function_.manifest())),
      shape_{function_.cells(), function_.voxel_m(), function_.height_range_m()},
      manifest_json_(protocol::manifest_json(function_.manifest())),
      etag_manifest_(etag_of(hash_, kManifestEdition)),
      etag_tileset_(etag_of(hash_, kTilesetEdition)) {
  std::ranges::transform(kEditions, etags_.begin(), [&](std::string_view edition) { return etag_of(hash_, edition); });
  const std::string map_edition(kEditions[static_cast<std::size_t>(PayloadFormat::kMap)]);
  std::ranges::transform(kMapLayerNames, layer_etags_.begin(), [&](std::string_view layer) {
    return etag_of(hash_, map_edition + "-" + std::string(layer));
  });
}

std::size_t world_index(const Worlds& worlds, std::string_view name) {
  const auto found =
      std::find_if(worlds.begin(), worlds.end(), [&](const auto& world) { return world->name() == name; });
  return static_cast<std::size_t>(found - worlds.begin());
}

std::string worlds_json(const Worlds& worlds) {
  std::string out = "{\"worlds\":[";
  for (const auto& world : worlds) {
    if (out.back() != '[') out += ',';
    out += "{\"name\":" + json_string(world->name()) + ",\"world_hash\":" + json_string(world->hash()) + "}";
  }
  return out + "]}";
}

}  // namespace talus::server
