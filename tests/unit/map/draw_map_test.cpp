#include "core/map/draw_map.hpp"

#include "core/map/map_tile.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/support/default_world.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

using test::world;

std::vector<std::uint8_t> drawn(const MapView& view, const MapStyle& style = {}) {
  MapScratch scratch;
  std::vector<std::uint8_t> rgb(std::size_t{3} * static_cast<std::size_t>(view.width * view.height));
  draw_map(world(), view, style, scratch, rgb);
  return rgb;
}

std::array<std::uint8_t, 3> pixel(const std::vector<std::uint8_t>& rgb, const MapView& view, int i, int k) {
  const std::size_t at = std::size_t{3} * static_cast<std::size_t>(k * view.width + i);
  return {rgb[at], rgb[at + 1], rgb[at + 2]};
}

TEST(Map, ColoursAPixelAlikeInEveryView) {
  for (const MapStyle& style : {MapStyle{}, MapStyle{MapLayer::kMaterial, 25}, MapStyle{MapLayer::kRidge, 0}}) {
    for (const std::int64_t pixel_voxels : {std::int64_t{1}, std::int64_t{64}}) {
      const int samples = pixel_voxels == 1 ? 1 : 2;
      const MapView whole{-100 * pixel_voxels, 40 * pixel_voxels, pixel_voxels, samples, 150, 30};
      const MapView part{-60 * pixel_voxels, 50 * pixel_voxels, pixel_voxels, samples, 70, 9};
      const auto a = drawn(whole, style);
      const auto b = drawn(part, style);
      for (int k = 0; k < part.height; ++k) {
        for (int i = 0; i < part.width; ++i)
          ASSERT_EQ(pixel(a, whole, i + 40, k + 10), pixel(b, part, i, k)) << i << ' ' << k;
      }
    }
  }
}

TEST(MapTile, HalvesItsPixelsFromZoomToZoomAndCoversTheSameGround) {
  for (int zoom = 0; zoom < kMapZoomMax; ++zoom) {
    const MapView coarse = map_view({zoom, -3, 5});
    const MapView fine = map_view({zoom + 1, -6, 10});
    EXPECT_EQ(coarse.pixel_voxels, 2 * fine.pixel_voxels);
    EXPECT_EQ(coarse.x_voxel, fine.x_voxel);
    EXPECT_EQ(coarse.z_voxel, fine.z_voxel);
  }
  EXPECT_EQ(map_view({kMapZoomMax, 1, -1}).x_voxel, 256);
  EXPECT_EQ(map_view({kMapZoomMax, 1, -1}).z_voxel, -256);
}

TEST(MapTile, ReachesAsFarAsChunksOfLodZero) {
  for (const int cells : {16, 32}) {
    for (int zoom = 0; zoom <= kMapZoomMax; ++zoom) {
      const std::int32_t limit = map_tile_limit(zoom, cells);
      EXPECT_TRUE(is_valid(MapTile{zoom, limit - 1, -limit}, cells));
      EXPECT_FALSE(is_valid(MapTile{zoom, limit, 0}, cells));
      EXPECT_FALSE(is_valid(MapTile{zoom, 0, -limit - 1}, cells));
      EXPECT_EQ(-map_view({zoom, -limit, 0}).x_voxel, (std::int64_t{kChunkLimit} + 1) * cells);
    }
    EXPECT_FALSE(is_valid(MapTile{-1, 0, 0}, cells));
    EXPECT_FALSE(is_valid(MapTile{kMapZoomMax + 1, 0, 0}, cells));
  }
}

TEST(MapTile, MeetsItsNeighbourWithoutASeam) {
  // A view that lies across the border of two tiles has the pixels of both.
  const MapView left = map_view({6, -1, 0});
  const MapView right = map_view({6, 0, 0});
  MapView across = left;
  across.x_voxel = left.x_voxel + 200 * left.pixel_voxels;
  const auto a = drawn(left);
  const auto b = drawn(right);
  const auto c = drawn(across);
  for (int k = 0; k < kMapTilePixels; k += 5) {
    for (int i = 0; i < 56; ++i) ASSERT_EQ(pixel(c, across, i, k), pixel(a, left, 200 + i, k));
    for (int i = 56; i < 256; ++i) ASSERT_EQ(pixel(c, across, i, k), pixel(b, right, i - 56, k));
  }
}

TEST(Map, PaintsTheSeaBlueAndLandNot) {
  const MapView view{-32768, -32768, 512, 1, 128, 128};
  const auto rgb = drawn(view);
  ColumnBlock block;
  world().columns({view.x_voxel, view.z_voxel, 512, 128, 128, world().voxel_m()}, block);
  int sea = 0;
  int land = 0;
  for (int k = 0; k < 128; ++k) {
    for (int i = 0; i < 128; ++i) {
      const float height = block.height_m[static_cast<std::size_t>(k) * block.stride + static_cast<std::size_t>(i)];
      const auto [red, green, blue] = pixel(rgb, view, i, k);
      if (height < 0) {
        EXPECT_GT(blue, red + 15) << i << ' ' << k;
        ++sea;
      } else if (height > 10 && height < 400) {
        EXPECT_GE(green + 40, blue) << i << ' ' << k;
        ++land;
      }
    }
  }
  EXPECT_GT(sea, 1000);
  EXPECT_GT(land, 1000);
}

TEST(Map, LightensSlopesThatFaceTheNorthWestLamp) {
  const MapView view{-8192, -8192, 64, 1, 256, 256};
  const auto rgb = drawn(view);
  ColumnBlock block;
  double towards = 0;
  double away = 0;
  int towards_count = 0;
  int away_count = 0;
  for (int k = 1; k < 255; ++k) {
    world().columns({view.x_voxel, view.z_voxel + (k - 1) * 64, 64, 160, 3, world().voxel_m()}, block);
    for (int i = 1; i < 159; ++i) {
      const auto at = block.stride + static_cast<std::size_t>(i);
      const float x = block.height_m[at + 1] - block.height_m[at - 1];
      const float z = block.height_m[at + block.stride] - block.height_m[at - block.stride];
      if (block.height_m[at] < 50 || block.height_m[at] > 500 || std::abs(x + z) < 40) continue;
      const int light = pixel(rgb, view, i, k)[1];
      // The ground rises away from a lamp that stands where x and z are low.
      (x + z > 0 ? towards : away) += light;
      ++(x + z > 0 ? towards_count : away_count);
    }
  }
  ASSERT_GT(towards_count, 500);
  ASSERT_GT(away_count, 500);
  EXPECT_GT(towards / towards_count, 1.4 * away / away_count);
}

TEST(Map, ShowsSomethingOnEveryLayerAndKnowsThemByName) {
  constexpr int kEdge = test::kIsSanitized ? 64 : 128;
  for (std::size_t layer = 0; layer < kMapLayerNames.size(); ++layer) {
    ASSERT_EQ(map_layer(kMapLayerNames[layer]), static_cast<MapLayer>(layer));
    const MapView view{-4096, -4096, 8192 / kEdge, 2, kEdge, kEdge};
    const auto rgb = drawn(view, {static_cast<MapLayer>(layer), 0});
    std::set<std::array<std::uint8_t, 3>> colours;
    for (int p = 0; p < kEdge * kEdge; ++p) colours.insert(pixel(rgb, view, p, 0));
    EXPECT_GT(colours.size(), 20U) << kMapLayerNames[layer];
  }
  EXPECT_FALSE(map_layer("shade"));
}

TEST(Map, DrawsContourLinesWhereTheHeightPassesThem) {
  const MapView view{0, 0, 16, 1, 64, 64};
  const auto plain = drawn(view);
  const auto lined = drawn(view, {MapLayer::kShaded, 100});
  int darker = 0;
  for (std::size_t i = 0; i < plain.size(); i += 3) {
    EXPECT_LE(lined[i], plain[i]);
    darker += lined[i] < plain[i] ? 1 : 0;
  }
  EXPECT_GT(darker, 64);
  EXPECT_LT(darker, 64 * 64 / 2);
}

}  // namespace
}  // namespace talus
