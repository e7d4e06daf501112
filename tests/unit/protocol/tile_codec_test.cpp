#include "protocol/tile_codec.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "protocol/mesh_codec.hpp"
#include "tests/support/random.hpp"

namespace talus::protocol {
namespace {

constexpr ChunkKey kKey{3, -7, 0, kChunkLimit};

HeightTile random_height(test::Random& random, int cells, std::int64_t spread) {
  HeightTile tile{cells, 0.125, {}, {}, {}};
  for (int i = 0; i < (cells + 1) * (cells + 1); ++i) {
    tile.heights.push_back(static_cast<std::int32_t>(random.whole(-spread, spread)));
    tile.ridges.push_back(static_cast<std::uint8_t>(random.bits()));
    tile.materials.push_back(static_cast<std::uint8_t>(random.whole(0, 14)));
  }
  return tile;
}

DensityTile random_density(test::Random& random, int cells, int spread) {
  DensityTile tile{cells, 0.0625, {}, {}};
  for (int i = 0; i < (cells + 1) * (cells + 1) * (cells + 1); ++i) {
    tile.densities.push_back(static_cast<std::int16_t>(random.whole(-spread, spread - 1)));
    tile.materials.push_back(tile.densities.back() < 0 ? static_cast<std::uint8_t>(random.whole(0, 14)) : kNoMaterial);
  }
  return tile;
}

TEST(TileCodec, GivesHeightsBackWhateverTheirSpread) {
  test::Random random(7);
  for (const std::int64_t spread : {std::int64_t{0}, std::int64_t{3}, std::int64_t{40'000}, std::int64_t{1} << 31}) {
    for (const int cells : {1, 2, 32, kTileCellsMax}) {
      HeightTile tile = random_height(random, cells, std::min<std::int64_t>(spread, (std::int64_t{1} << 31) - 1));
      const auto decoded = decode_height(*encode_height(tile, kKey));
      ASSERT_TRUE(decoded) << cells << " cells, spread " << spread;
      EXPECT_EQ(decoded->tile.heights, tile.heights);
      EXPECT_EQ(decoded->tile.ridges, tile.ridges);
      EXPECT_EQ(decoded->tile.materials, tile.materials);
      EXPECT_EQ(decoded->tile.step_m, tile.step_m);
      EXPECT_EQ(decoded->key, kKey);
    }
  }
}

TEST(TileCodec, GivesDensitiesBackWhateverTheyAre) {
  test::Random random(8);
  for (const int spread : {1, 60, kDensityHeld}) {
    for (const int cells : {1, 2, 32}) {
      const DensityTile tile = random_density(random, cells, spread);
      const auto decoded = decode_density(*encode_density(tile, {3, -7, 5, kChunkLimit}));
      ASSERT_TRUE(decoded) << cells << " cells, spread " << spread;
      EXPECT_EQ(decoded->tile.densities, tile.densities);
      EXPECT_EQ(decoded->tile.materials, tile.materials);
      EXPECT_EQ(decoded->key, (ChunkKey{3, -7, 5, kChunkLimit}));
    }
  }
}

TEST(TileCodec, RefusesEveryStrictPrefixAndAnythingBehind) {
  test::Random random(9);
  auto height = *encode_height(random_height(random, 4, 100), kKey);
  auto density = *encode_density(random_density(random, 4, 100), kKey);
  for (std::size_t size = 0; size < height.size(); ++size) {
    EXPECT_FALSE(decode_height(std::span(height).first(size))) << size;
  }
  for (std::size_t size = 0; size < density.size(); ++size) {
    EXPECT_FALSE(decode_density(std::span(density).first(size))) << size;
  }
  height.push_back(std::byte{0});
  density.push_back(std::byte{0});
  EXPECT_FALSE(decode_height(height));
  EXPECT_FALSE(decode_density(density));
}

TEST(TileCodec, RefusesHeadersThatPromiseWhatNoTileHas) {
  test::Random random(10);
  const auto height = *encode_height(random_height(random, 4, 100), kKey);
  struct Change {
    std::size_t at;
    std::uint8_t value;
  };
  constexpr std::array<Change, 10> kChanges{
      {{0, 0}, {4, 2}, {5, 13}, {6, 0}, {6, 63}, {6, 5}, {7, 5}, {7, 0}, {11, 0x7F}, {16, 1}}};
  for (const Change& change : kChanges) {
    auto changed = height;
    changed[change.at] = static_cast<std::byte>(change.value);
    EXPECT_FALSE(decode_height(changed)) << change.at;
  }
  EXPECT_FALSE(decode_height(std::vector<std::byte>(2 * 1024 * 1024)));
}

TEST(TileCodec, RefusesDensitiesBeyondWhatIsHeld) {
  test::Random random(11);
  DensityTile tile = random_density(random, 2, kDensityHeld);
  tile.densities[13] = std::numeric_limits<std::int16_t>::max();
  EXPECT_FALSE(decode_density(*encode_density(tile, kKey)));
}

}  // namespace
}  // namespace talus::protocol
