// A manifest as clients see it. Field names are those of the HTTP interface; SPEC.md, "Manifest".
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/grid/chunk_key.hpp"
#include "core/map/map_tile.hpp"
#include "core/strata/material.hpp"
#include "core/world/world_function.hpp"
#include "protocol/limits.hpp"
#include "protocol/manifest_toml.hpp"

namespace talus::protocol {
namespace {

using Json = nlohmann::ordered_json;

std::string colour_text(std::uint32_t rgb) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%06x", rgb & 0xFFFFFFU);
  return text.data();
}

Json materials_json() {
  Json out = Json::array();
  for (const MaterialInfo& material : kMaterials) {
    out.push_back(
        {{"name", material.name}, {"colour", colour_text(material.colour_rgb)}, {"erodibility", material.erodibility}});
  }
  return out;
}

Json limits_json() {
  return {{"inbound_message_bytes", kInboundMessageBytesMax},
          {"outbound_message_bytes", kOutboundMessageBytesMax},
          {"keys_per_message", kKeysPerMessageMax},
          {"wanted_keys", kWantedKeysMax},
          {"view_lod_max", kViewLodMax},
          {"near_edges", {kNearEdgesMin, kNearEdgesMax}},
          {"far_m", kFarMax},
          {"lod_bias", kLodBiasMax}};
}

/// Whole numbers without a fraction, so that 32 is not written 32.0.
Json number_json(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  return static_cast<double>(whole) == value ? Json(whole) : Json(value);
}

Json parameters_json(const Manifest& manifest) {
  Json out = Json::array();
  const std::span<const ParameterInfo> parameters = manifest_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterInfo& info = parameters[i];
    out.push_back({{"name", info.name},
                   {"unit", info.unit},
                   {"value", number_json(manifest.values[i])},
                   {"low", number_json(info.low)},
                   {"high", number_json(info.high)},
                   {"default", number_json(info.initial)},
                   {"meaning", info.meaning}});
  }
  return out;
}

/// Map tiles: enough to turn a place into a tile and a pixel.
Json map_json(const WorldFunction& world) {
  Json limits = Json::array();
  for (int zoom = 0; zoom <= kMapZoomMax; ++zoom) limits.push_back(map_tile_limit(zoom, world.cells()));
  const auto coarsest = static_cast<double>(map_view({0, 0, 0}).pixel_voxels);
  return {{"tile_pixels", kMapTilePixels},
          {"zoom_max", kMapZoomMax},
          {"pixel_m", number_json(coarsest * world.voxel_m())},
          {"tile_limit", limits},
          {"layers", kMapLayerNames}};
}

}  // namespace

std::string manifest_json(const Manifest& manifest) {
  const WorldFunction world(manifest);
  const glm::dvec2 heights = world.height_range_m();
  const Json out{{"name", manifest.name},
                 {"seed", std::to_string(manifest.seed)},
                 {"world_hash", world_hash(manifest)},
                 {"generator_version", kGeneratorVersion},
                 {"chunk_cells", world.cells()},
                 {"voxel_m", number_json(world.voxel_m())},
                 {"lod_max", kLodMax},
                 {"chunk_limit", kChunkLimit},
                 {"sea_level_m", 0},
                 {"height_range_m", {number_json(heights.x), number_json(heights.y)}},
                 {"materials", materials_json()},
                 {"formats", {"drc", "mesh", "glb", "density", "height"}},
                 {"map", map_json(world)},
                 {"limits", limits_json()},
                 {"parameters", parameters_json(manifest)}};
  return out.dump();
}

}  // namespace talus::protocol
