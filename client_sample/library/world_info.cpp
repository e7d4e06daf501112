#include "client_sample/library/world_info.hpp"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/grid/chunk_key.hpp"
#include "protocol/manifest_toml.hpp"

namespace talus::client {
namespace {

using Json = nlohmann::json;

bool is_power_of_two(double v) {
  int exponent = 0;
  return std::isfinite(v) && v > 0 && std::frexp(v, &exponent) == 0.5;
}

bool is_sound(const WorldInfo& info) {
  const protocol::WorldShape& shape = info.shape;
  return (shape.cells == 16 || shape.cells == 32) && is_power_of_two(shape.voxel_m) && shape.voxel_m >= 1.0 / 64 &&
         shape.voxel_m <= 64 && std::abs(shape.height_range_m.x) < 1.0e6 && std::abs(shape.height_range_m.y) < 1.0e6 &&
         shape.height_range_m.x <= shape.height_range_m.y && info.lod_max >= 0 && info.lod_max <= kLodMax;
}

}  // namespace

std::optional<WorldInfo> parse_world_info(std::string_view manifest_json) {
  const Json json = Json::parse(manifest_json, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    WorldInfo out;
    out.name = json.at("name").get<std::string>();
    out.world_hash = json.at("world_hash").get<std::string>();
    out.seed = json.at("seed").get<std::string>();
    out.generator_version = json.at("generator_version").get<std::uint32_t>();
    out.shape.cells = json.at("chunk_cells").get<int>();
    out.shape.voxel_m = json.at("voxel_m").get<double>();
    out.shape.height_range_m = {json.at("height_range_m").at(0).get<double>(),
                                json.at("height_range_m").at(1).get<double>()};
    out.sea_level_m = json.at("sea_level_m").get<double>();
    out.lod_max = json.at("lod_max").get<int>();
    out.manifest_json = manifest_json;
    if (!is_sound(out)) return std::nullopt;
    return out;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::optional<Manifest> manifest_of(const WorldInfo& info) {
  const Json json = Json::parse(info.manifest_json, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Manifest out;
  out.name = info.name;
  const char* end = info.seed.data() + info.seed.size();
  if (std::from_chars(info.seed.data(), end, out.seed).ptr != end) return std::nullopt;
  try {
    for (const Json& parameter : json.at("parameters")) {
      const std::size_t at = parameter_index(parameter.at("name").get<std::string>());
      if (at >= out.values.size()) return std::nullopt;
      out.values[at] = parameter.at("value").get<double>();
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  // The hash is made of every parameter and the generator version: equal hashes, equal chunks.
  if (protocol::world_hash(out) != info.world_hash) return std::nullopt;
  return out;
}

std::vector<double> parse_heights(std::string_view body) {
  const Json json = Json::parse(body, nullptr, false);
  std::vector<double> out;
  try {
    for (const Json& point : json.at("points")) out.push_back(point.at("height_m").get<double>());
  } catch (const Json::exception&) {
    return {};
  }
  return out;
}

std::optional<glm::dvec3> parse_spawn(std::string_view body) {
  const Json json = Json::parse(body, nullptr, false);
  const auto number = [&](const char* field) {
    return json.is_object() && json.contains(field) && json[field].is_number() ? json[field].get<double>() : NAN;
  };
  const glm::dvec3 out{number("x"), number("y"), number("z")};
  if (!std::isfinite(out.x) || !std::isfinite(out.y) || !std::isfinite(out.z)) return std::nullopt;
  return out;
}

std::string error_text(std::string_view body) {
  const Json json = Json::parse(body, nullptr, false);
  if (json.is_object() && json.contains("message") && json["message"].is_string()) {
    return json["message"].get<std::string>();
  }
  return std::string(body.substr(0, 200));
}

}  // namespace talus::client
