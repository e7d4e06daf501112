#include "protocol/tileset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/check.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "protocol/tile_bytes.hpp"

namespace talus::protocol {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kBranches = 4;

/// Tiles of a quadtree's levels 0 .. levels - 1.
constexpr std::size_t tiles_of(int levels) {
  return ((std::size_t{1} << (2 * levels)) - 1) / (kBranches - 1);
}

int first_content_level(const TileTree& tree) {
  return std::max(tree.levels - 1 - kLodMax, 0);
}

/// How far a coarse mesh may be from the world: the edge of its cells.
double error_of(const WorldShape& shape, int lod) {
  return std::ldexp(shape.voxel_m, lod);
}

/// A square of ground as a box in the tileset's frame: z up, y against world z. Vertices leave the heights by at most a
/// step of the coarsest lattice (extraction keeps them off samples); a step more is for rounding.
Json box_json(const WorldShape& shape, const glm::dvec2& low_m, double side_m, int lod, const glm::dvec2& origin_m,
              const glm::dvec2& heights_m) {
  const double slack_m = 2.0 * error_of(shape, std::min(lod, kLodMax)) / kStepsPerCell;
  const double bottom_m = heights_m.x - slack_m;
  const double top_m = heights_m.y + slack_m;
  const double half_m = side_m / 2;
  return {{"box",
           {low_m.x + half_m - origin_m.x, origin_m.y - low_m.y - half_m, (bottom_m + top_m) / 2, half_m, 0, 0, 0,
            half_m, 0, 0, 0, (top_m - bottom_m) / 2}}};
}

Json implicit_json(const std::string& tree_url, int levels, const std::string& query) {
  const std::string tile = tree_url + "/{level}/{x}/{y}";
  return {{"refine", "REPLACE"},
          {"content", {{"uri", tile + ".glb" + query}}},
          {"implicitTiling",
           {{"subdivisionScheme", "QUADTREE"},
            {"subtreeLevels", kSubtreeLevels},
            {"availableLevels", levels},
            {"subtrees", {{"uri", tile + ".subtree"}}}}}};
}

/// East, north, up at a place on the WGS 84 ellipsoid as columns, and the place: from the tileset's frame to the
/// globe's.
Json globe_json(const glm::dvec2& latitude_longitude_deg) {
  constexpr double kEquatorM = 6378137.0;
  constexpr double kFlattening = 1 / 298.257223563;
  constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
  const double latitude = latitude_longitude_deg.x * std::numbers::pi / 180;
  const double longitude = latitude_longitude_deg.y * std::numbers::pi / 180;
  const double sin_lat = std::sin(latitude);
  const double cos_lat = std::cos(latitude);
  const double sin_lon = std::sin(longitude);
  const double cos_lon = std::cos(longitude);
  const double curve_m = kEquatorM / std::sqrt(1 - kEccentricity2 * sin_lat * sin_lat);
  return {-sin_lon,
          cos_lon,
          0,
          0,
          -sin_lat * cos_lon,
          -sin_lat * sin_lon,
          cos_lat,
          0,
          cos_lat * cos_lon,
          cos_lat * sin_lon,
          sin_lat,
          0,
          curve_m * cos_lat * cos_lon,
          curve_m * cos_lat * sin_lon,
          curve_m * (1 - kEccentricity2) * sin_lat,
          1};
}

Json world_root(const WorldShape& shape) {
  const int lod = kWorldTreeLevels - 1;
  const double side_m = edge_of(shape, lod);
  Json root{{"boundingVolume", box_json(shape, {-side_m / 2, -side_m / 2}, side_m, lod, {}, shape.height_range_m)},
            {"geometricError", error_of(shape, lod)}};
  root.update(implicit_json("world", kWorldTreeLevels, ""));
  return root;
}

/// The coarsest LOD whose columns are not larger than the square is half wide: at most 3 x 3 of them meet it.
int root_lod(const WorldShape& shape, double km) {
  int lod = 0;
  while (lod < kLodMax && edge_of(shape, lod) < km * 1000) ++lod;
  return lod;
}

/// The columns of root_lod that meet the square.
ColumnSquare root_columns(const WorldShape& shape, const glm::dvec2& origin_m, double km) {
  const int lod = root_lod(shape, km);
  const auto column = [&](double m) {
    const double limit = kChunkLimit;
    return static_cast<std::int32_t>(std::clamp(std::floor(m / edge_of(shape, lod)), -limit, limit));
  };
  const glm::dvec2 low_m = origin_m - km * 1000;
  const glm::dvec2 high_m = origin_m + km * 1000;
  const std::int32_t x = column(low_m.x);
  const std::int32_t z = column(low_m.y);
  return {lod, x, z, std::max(column(high_m.x) - x, column(high_m.y) - z) + 1};
}

/// What all tiles of a local tileset share.
struct LocalFrame {
  const WorldShape& shape;
  glm::dvec2 origin_m;
  std::string query;  ///< of content
  ColumnSquare known;
  std::span<const glm::dvec2> heights_m;  ///< of `known`
};

glm::dvec2 both(const glm::dvec2& a, const glm::dvec2& b) {
  return {std::min(a.x, b.x), std::max(a.y, b.y)};
}

/// The tile of one column, and its heights. Tiles are spelled out down to the columns of known heights, where implicit
/// trees begin, since a box of an implicit tile is as high as that of its tree.
std::pair<Json, glm::dvec2> column_json(const LocalFrame& frame, int lod, std::int32_t x, std::int32_t z) {
  const std::string url = std::to_string(lod) + "/" + std::to_string(x) + "/" + std::to_string(z);
  Json below;
  glm::dvec2 heights_m{};
  if (lod == frame.known.lod) {
    below = implicit_json(url, lod + 1, frame.query);
    heights_m = frame.heights_m[static_cast<std::size_t>((z - frame.known.z) * frame.known.side + x - frame.known.x)];
  } else {
    below = {{"refine", "REPLACE"}, {"content", {{"uri", url + "/0/0/0.glb" + frame.query}}}};
    for (int child = 0; child < kBranches; ++child) {
      auto [json, child_m] = column_json(frame, lod - 1, 2 * x + child % 2, 2 * z + child / 2);
      heights_m = child == 0 ? child_m : both(heights_m, child_m);
      below["children"].push_back(std::move(json));
    }
  }
  const double edge_m = edge_of(frame.shape, lod);
  Json out{{"boundingVolume", box_json(frame.shape, {x * edge_m, z * edge_m}, edge_m, lod, frame.origin_m, heights_m)},
           {"geometricError", error_of(frame.shape, lod)}};
  out.update(below);
  return {std::move(out), heights_m};
}

Json local_root(const WorldShape& shape, const TilesetPlace& place, std::span<const glm::dvec2> heights_m) {
  const glm::dvec2 origin_m = *place.origin_m;
  const ColumnSquare roots = root_columns(shape, origin_m, place.km);
  const double edge_m = edge_of(shape, roots.lod);
  const std::string query = "?origin=" + Json(origin_m.x).dump() + ",0," + Json(origin_m.y).dump();
  const LocalFrame frame{shape, origin_m, query, tileset_columns(shape, place), heights_m};
  Json children = Json::array();
  glm::dvec2 all_m = heights_m.front();
  for (int i = 0; i < roots.side * roots.side; ++i) {
    auto [json, child_m] = column_json(frame, roots.lod, roots.x + i % roots.side, roots.z + i / roots.side);
    all_m = both(all_m, child_m);
    children.push_back(std::move(json));
  }
  return {{"boundingVolume",
           box_json(shape, {roots.x * edge_m, roots.z * edge_m}, roots.side * edge_m, roots.lod, origin_m, all_m)},
          {"geometricError", 2 * error_of(shape, roots.lod)},
          {"refine", "REPLACE"},
          {"children", std::move(children)}};
}

/// One availability: a constant where it is one, else bits, lowest first, appended to `bits`.
Json availability_json(const std::vector<bool>& available, std::vector<std::byte>& bits, Json& views) {
  const auto count = std::ranges::count(available, true);
  if (count == 0) return {{"constant", 0}};
  if (static_cast<std::size_t>(count) == available.size()) return {{"constant", 1}};
  const std::size_t begin = bits.size();
  const std::size_t bytes = (available.size() + 7) / 8;
  bits.resize(begin + (bytes + 7) / 8 * 8);  // views begin at multiples of 8
  for (std::size_t i = 0; i < available.size(); ++i) {
    if (available[i]) bits[begin + i / 8] |= static_cast<std::byte>(1U << (i % 8));
  }
  views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes}});
  return {{"bitstream", views.size() - 1}, {"availableCount", count}};
}

/// Bits of a subtree's tiles, level by level, each set where its level of the tree is within [first, end).
std::vector<bool> levels_within(int subtree_level, int first, int end) {
  std::vector<bool> out;
  for (int level = 0; level < kSubtreeLevels; ++level) {
    const bool is_within = subtree_level + level >= first && subtree_level + level < end;
    out.insert(out.end(), std::size_t{1} << (2 * level), is_within);
  }
  TALUS_CHECK(out.size() == tiles_of(kSubtreeLevels));
  return out;
}

}  // namespace

TileTree world_tree() {
  const std::int64_t half = std::int64_t{1} << (kWorldTreeLevels - 2);
  return {kWorldTreeLevels, -half, -half};
}

TileTree column_tree(int lod, std::int32_t x, std::int32_t z) {
  return {lod + 1, std::int64_t{x} * (std::int64_t{1} << lod), std::int64_t{z} * (std::int64_t{1} << lod)};
}

std::optional<ChunkKey> column_of(const TileTree& tree, const TileId& tile) {
  if (tile.level < first_content_level(tree) || tile.level >= tree.levels) return std::nullopt;
  const std::int64_t side = std::int64_t{1} << tile.level;
  if (tile.x >= side || tile.y >= side) return std::nullopt;
  const int lod = tree.levels - 1 - tile.level;
  const std::int64_t x = (tree.x >> lod) + tile.x;
  const std::int64_t z = (tree.z >> lod) + side - 1 - tile.y;
  if (std::max(std::abs(x), std::abs(z)) > kChunkLimit) return std::nullopt;
  return ChunkKey{lod, static_cast<std::int32_t>(x), 0, static_cast<std::int32_t>(z)};
}

bool has_subtree(const TileTree& tree, const TileId& tile) {
  if (tile.level < 0 || tile.level >= tree.levels || tile.level % kSubtreeLevels != 0) return false;
  const std::int64_t side = std::int64_t{1} << tile.level;
  return tile.x < side && tile.y < side;
}

std::vector<std::byte> encode_subtree(const TileTree& tree, int level) {
  TALUS_CHECK(level >= 0 && level < tree.levels && level % kSubtreeLevels == 0);
  std::vector<std::byte> bits;
  Json views = Json::array();
  Json json;
  const Json tiles = availability_json(levels_within(level, 0, tree.levels), bits, views);
  const Json contents = availability_json(levels_within(level, first_content_level(tree), tree.levels), bits, views);
  if (!bits.empty()) {
    json["buffers"] = {{{"byteLength", bits.size()}}};
    json["bufferViews"] = views;
  }
  json["tileAvailability"] = tiles;
  json["contentAvailability"] = {contents};
  json["childSubtreeAvailability"] = {{"constant", level + kSubtreeLevels < tree.levels ? 1 : 0}};

  constexpr std::uint32_t kSubtreeMagic = 0x74627573;  // "subt"
  std::string text = json.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');
  std::vector<std::byte> out;
  put_number(out, kSubtreeMagic);
  put_number(out, std::uint32_t{1});
  put_number(out, std::uint64_t{text.size()});
  put_number(out, std::uint64_t{bits.size()});
  const auto json_bytes = std::as_bytes(std::span(text));
  out.insert(out.end(), json_bytes.begin(), json_bytes.end());
  out.insert(out.end(), bits.begin(), bits.end());
  return out;
}

ColumnSquare tileset_columns(const WorldShape& shape, const TilesetPlace& place) {
  TALUS_CHECK(place.origin_m && place.km > 0 && place.km <= kTilesetKmMax);
  // 16 columns a root: more would end boxes nearer to the ground, and cost as many looks at it.
  constexpr int kLodsSpelledOut = 2;
  const ColumnSquare roots = root_columns(shape, *place.origin_m, place.km);
  const int levels = std::min(roots.lod, kLodsSpelledOut);
  const std::int32_t branches = 1 << levels;
  return {roots.lod - levels, roots.x * branches, roots.z * branches, roots.side * branches};
}

std::string encode_tileset(const WorldShape& shape, const TilesetPlace& place, std::span<const glm::dvec2> heights_m) {
  if (place.origin_m) {
    const auto side = static_cast<std::size_t>(tileset_columns(shape, place).side);
    TALUS_CHECK(heights_m.size() == side * side);
  }
  Json root = place.origin_m ? local_root(shape, place, heights_m) : world_root(shape);
  if (place.latitude_longitude_deg) root["transform"] = globe_json(*place.latitude_longitude_deg);
  const double error = 2 * root["geometricError"].get<double>();
  const Json out{{"asset", {{"version", "1.1"}, {"generator", "talus"}}}, {"geometricError", error}, {"root", root}};
  return out.dump();
}

}  // namespace talus::protocol
