#include "protocol/tileset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/random.hpp"

namespace talus::protocol {
namespace {

using Json = nlohmann::json;

const WorldShape kShape{32, 1.0, {-700.0, 2600.0}};

Json json_of_subtree(const std::vector<std::byte>& bytes) {
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  return Json::parse(std::string(reinterpret_cast<const char*>(bytes.data()) + 24, length));
}

/// Whether bit `at` of an availability is set.
bool is_set(const std::vector<std::byte>& bytes, const Json& json, const Json& availability, std::size_t at) {
  if (availability.contains("constant")) return availability["constant"] == 1;
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  const Json& view = json["bufferViews"][availability["bitstream"].get<std::size_t>()];
  const std::size_t byte = 24 + length + view["byteOffset"].get<std::size_t>() + at / 8;
  return (bytes.at(byte) >> (at % 8) & std::byte{1}) == std::byte{1};
}

/// A tile's box in the frame of its tileset: low and high corner.
struct Box {
  glm::dvec3 low;
  glm::dvec3 high;
};
/// What the specification's subdivision makes of the root's box.
Box box_of_tile(const Json& root, const TileId& tile) {
  const auto v = root["boundingVolume"]["box"].get<std::vector<double>>();
  const glm::dvec3 half{v[3], v[7], v[11]};
  const glm::dvec3 low = glm::dvec3{v[0], v[1], v[2]} - half;
  const double side = std::ldexp(2 * half.x, -tile.level);
  return {{low.x + tile.x * side, low.y + tile.y * side, low.z},
          {low.x + (tile.x + 1) * side, low.y + (tile.y + 1) * side, low.z + 2 * half.z}};
}

TEST(Tileset, SaysOfEveryTileWhetherItIsThereAndHasContent) {
  for (const TileTree& tree : {world_tree(), column_tree(0, 1, 2), column_tree(6, -3, 4), column_tree(12, 0, -1)}) {
    for (int level = 0; level < tree.levels; level += kSubtreeLevels) {
      const auto bytes = encode_subtree(tree, level);
      EXPECT_EQ(bytes.size() % 8, 0U);
      const Json json = json_of_subtree(bytes);
      std::size_t at = 0;
      for (int below = 0; below < kSubtreeLevels; ++below) {
        for (std::uint32_t i = 0; i < 1U << (2 * below); ++i, ++at) {
          const bool is_there = level + below < tree.levels;
          const TileId tile{level + below, i % (1U << below), i >> below};
          ASSERT_EQ(is_set(bytes, json, json["tileAvailability"], at), is_there);
          ASSERT_EQ(is_set(bytes, json, json["contentAvailability"][0], at), column_of(tree, tile).has_value());
        }
      }
      const bool goes_on = level + kSubtreeLevels < tree.levels;
      EXPECT_EQ(json["childSubtreeAvailability"]["constant"], goes_on ? 1 : 0);
      EXPECT_EQ(has_subtree(tree, {level + kSubtreeLevels, 0, 0}), goes_on);
    }
  }
}

TEST(Tileset, GivesEveryColumnOfATreeToOneTile) {
  const TileTree tree = column_tree(3, -2, 5);
  std::set<ChunkKey> seen;
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 8; ++x) {
      const auto key = column_of(tree, {3, x, y});
      ASSERT_TRUE(key);
      EXPECT_EQ(key->lod, 0);
      EXPECT_TRUE(key->x >= -16 && key->x < -8 && key->z >= 40 && key->z < 48);
      seen.insert(*key);
    }
  }
  EXPECT_EQ(seen.size(), 64U);
  EXPECT_FALSE(column_of(tree, {3, 8, 0}));
  EXPECT_FALSE(column_of(tree, {4, 0, 0}));
  EXPECT_FALSE(column_of(tree, {-1, 0, 0}));
}

/// The root of a local tileset whose ground is `heights_m` everywhere.
Json flat_root(const TilesetPlace& place, const glm::dvec2& heights_m = {-20, 300}) {
  const auto side = static_cast<std::size_t>(tileset_columns(kShape, place).side);
  return Json::parse(encode_tileset(kShape, place, std::vector(side * side, heights_m)))["root"];
}

/// Calls `visit(parent, tile)` for every tile below `tile`.
template <typename Visit>
void for_each_child(const Json& tile, const Visit& visit) {
  if (!tile.contains("children")) return;
  for (const Json& child : tile["children"]) {
    visit(tile, child);
    for_each_child(child, visit);
  }
}

bool holds(const Box& outer, const Box& inner) {
  constexpr double kRounding = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.low[axis] < outer.low[axis] - kRounding || inner.high[axis] > outer.high[axis] + kRounding) return false;
  }
  return true;
}

TEST(Tileset, HalvesErrorsThatFollowTheCells) {
  const Json world = Json::parse(encode_tileset(kShape, {}, {}));
  EXPECT_EQ(world["asset"]["version"], "1.1");
  EXPECT_EQ(world["root"]["implicitTiling"]["availableLevels"], kWorldTreeLevels);
  EXPECT_EQ(world["root"]["geometricError"], std::ldexp(1.0, kWorldTreeLevels - 1)) << "1 m at LOD 0";
  EXPECT_GE(world["geometricError"], world["root"]["geometricError"]);
  for (const double km : {0.01, 0.05, 4.0, 64.0}) {
    const Json root = flat_root({glm::dvec2{-70, 1e6}, km, std::nullopt});
    int trees = 0;
    for_each_child(root, [&](const Json& parent, const Json& child) {
      EXPECT_EQ(parent["geometricError"], 2 * child["geometricError"].get<double>());
      if (!child.contains("implicitTiling")) return;
      ++trees;
      EXPECT_EQ(child["geometricError"], std::ldexp(1.0, child["implicitTiling"]["availableLevels"].get<int>() - 1));
    });
    const int side = tileset_columns(kShape, {glm::dvec2{-70, 1e6}, km, std::nullopt}).side;
    EXPECT_EQ(trees, side * side) << "one for each column whose heights are asked for";
  }
}

TEST(Tileset, CoversTheSquareThatIsAskedForWhereverItIs) {
  test::Random random(91);
  for (int round = 0; round < 50; ++round) {
    const glm::dvec2 origin{random.real(-1e9, 1e9), random.real(-1e9, 1e9)};
    const double km = random.real(0.01, kTilesetKmMax);
    const Json root = flat_root({origin, km, std::nullopt});
    ASSERT_LE(root["children"].size(), 9U);
    double area = 0;
    Box whole{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for_each_child(root, [&](const Json& parent, const Json& child) {
      const Box box = box_of_tile(child, {});
      EXPECT_TRUE(holds(box_of_tile(parent, {}), box));
      if (!child.contains("implicitTiling")) return;
      area += (box.high.x - box.low.x) * (box.high.y - box.low.y);
      whole.low = glm::min(whole.low, box.low);
      whole.high = glm::max(whole.high, box.high);
    });
    EXPECT_NEAR(area, (whole.high.x - whole.low.x) * (whole.high.y - whole.low.y), area * 1e-9) << "no gap, no overlap";
    const double half = km * 1000;
    EXPECT_TRUE(whole.low.x <= -half && whole.low.y <= -half && whole.high.x >= half && whole.high.y >= half);
  }
}

TEST(Tileset, EndsItsBoxesWhereTheGroundDoes) {
  const TilesetPlace place{glm::dvec2{0, 0}, 4.0, std::nullopt};
  const ColumnSquare columns = tileset_columns(kShape, place);
  std::vector<glm::dvec2> heights(static_cast<std::size_t>(columns.side * columns.side), {10, 20});
  heights[1] = {-30, 400};  // the second column along x
  const Json root = Json::parse(encode_tileset(kShape, place, heights))["root"];
  int high = 0;
  for_each_child(root, [&](const Json& /*parent*/, const Json& child) {
    if (!child.contains("implicitTiling")) return;
    const Box box = box_of_tile(child, {});
    EXPECT_NEAR(box.high.z, box.high.z > 100 ? 400 : 20, 5);
    EXPECT_NEAR(box.low.z, box.high.z > 100 ? -30 : 10, 5);
    if (box.high.z > 100) ++high;
  });
  EXPECT_EQ(high, 1);
  EXPECT_GT(box_of_tile(root, {}).high.z, 400) << "parents hold their children";
}

TEST(Tileset, StandsUprightOnTheGlobe) {
  const auto m = flat_root({glm::dvec2{0, 0}, 4.0, glm::dvec2{0, 90}})["transform"].get<std::vector<double>>();
  ASSERT_EQ(m.size(), 16U);
  // At 0 N, 90 E: east is -x, north is z, up is y.
  const std::vector<double> expected{-1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 6378137, 0, 1};
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(m[i], expected[i], 1e-6) << i;
  const auto pole =
      Json::parse(encode_tileset(kShape, {std::nullopt, 4.0, glm::dvec2{90, 0}}, {}))["root"]["transform"];
  EXPECT_NEAR(pole[14].get<double>(), 6356752.314245, 1e-5) << "the polar radius of WGS 84";
}

}  // namespace
}  // namespace talus::protocol
