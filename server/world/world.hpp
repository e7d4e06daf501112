// One world as this server hosts it: the function, and what every door says about it. Immutable; any thread.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/world/world_function.hpp"
#include "protocol/interest_area.hpp"
#include "server/cache/payload.hpp"

namespace talus::server {

class World {
 public:
  /// Requires manifest_faults(manifest) to be empty.
  explicit World(Manifest manifest);

  const std::string& name() const { return function_.manifest().name; }
  const std::string& hash() const { return hash_; }
  const WorldFunction& function() const { return function_; }
  const protocol::WorldShape& shape() const { return shape_; }
  /// The body of GET /v1/worlds/{world}.
  const std::string& manifest_json() const { return manifest_json_; }
  /// Quoted, strong, and known without generating: world hash, revision and format decide every byte of a payload.
  const std::string& etag(PayloadFormat format) const { return etags_[static_cast<std::size_t>(format)]; }
  /// The same of one payload: every layer of the map has its own.
  const std::string& etag(const PayloadName& name) const {
    return name.layer == MapLayer::kShaded ? etag(name.format) : layer_etags_[static_cast<std::size_t>(name.layer)];
  }
  /// Quoted: of the manifest's body.
  const std::string& manifest_etag() const { return etag_manifest_; }
  /// Quoted: of everything that describes the world's tiles.
  const std::string& tileset_etag() const { return etag_tileset_; }

 private:
  WorldFunction function_;
  std::string hash_;
  protocol::WorldShape shape_;
  std::string manifest_json_;
  std::array<std::string, kPayloadFormats> etags_;
  std::array<std::string, kMapLayerNames.size()> layer_etags_;  ///< of maps
  std::string etag_manifest_;
  std::string etag_tileset_;
};

/// The worlds of a server, in the order they were named; PayloadName::world is an index into it.
using Worlds = std::vector<std::unique_ptr<const World>>;

/// Index of the world called `name`, or worlds.size().
std::size_t world_index(const Worlds& worlds, std::string_view name);

/// The body of GET /v1/worlds.
std::string worlds_json(const Worlds& worlds);

}  // namespace talus::server
