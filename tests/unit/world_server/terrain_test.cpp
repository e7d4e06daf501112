#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "protocol/mesh_codec.hpp"
#include "server/world/place_query.hpp"
#include "server/world/terrain_builder.hpp"

#include "tests/support/rounds.hpp"

namespace talus::server {
namespace {

TEST(TerrainBuilder, GivesTheBytesOfBuildAndEncodeWhateverWasBuiltBefore) {
  Worlds worlds;
  worlds.push_back(std::make_unique<const World>(Manifest{}));
  const WorldFunction& world = worlds[0]->function();
  const SystemClock clock;
  Metrics metrics;
  TerrainBuilder builder(worlds, clock, metrics, 1);
  int meshes = 0;
  const std::int32_t last_x = test::kIsSanitized ? -1 : 1;
  for (const std::int32_t lod : {2, 5}) {
    for (std::int32_t x = -1; x <= last_x; ++x) {
      for (std::int32_t y = -8; y < 24; ++y) {
        const ChunkKey key{lod, x, y, 3};
        PayloadName name;
        name.key = key;
        const auto payload = builder.build(name, 0, CancelToken{});
        ASSERT_TRUE(payload.has_value());
        ChunkScratch scratch;
        ChunkMesh mesh;
        ASSERT_EQ(payload->kind, build_chunk(world, key, scratch, mesh));
        if (payload->kind != ChunkKind::kMesh) continue;
        ++meshes;
        EXPECT_EQ(payload->bytes,
                  *protocol::encode_draco(mesh, protocol::mesh_lattice(key, world.cells(), world.voxel_m())));
      }
    }
  }
  EXPECT_GT(meshes, test::rounds(5));
}

TEST(TerrainBuilder, MakesATileOfEveryLodOfOneMesh) {
  Worlds worlds;
  worlds.push_back(std::make_unique<const World>(Manifest{}));
  const SystemClock clock;
  Metrics metrics;
  TerrainBuilder builder(worlds, clock, metrics, 1);
  for (std::int32_t lod = 0; lod <= kLodMax; lod += test::kIsSanitized ? 3 : 1) {
    for (const std::int32_t x : {-1, 3}) {
      PayloadName name;
      name.format = PayloadFormat::kTile;
      name.key = {lod, x, 0, -2};
      const auto payload = builder.build(name, 0, CancelToken{});
      ASSERT_TRUE(payload.has_value());
      EXPECT_EQ(payload->kind, ChunkKind::kMesh);
      const std::string_view text(reinterpret_cast<const char*>(payload->bytes.data()), payload->bytes.size());
      const std::size_t mesh = text.find("\"bufferView\"");
      ASSERT_NE(mesh, std::string_view::npos) << "LOD " << lod << ": a column has a surface";
      EXPECT_EQ(text.find("\"bufferView\"", mesh + 1), std::string_view::npos) << "one mesh, strips and all";
    }
  }
}

TEST(TerrainBuilder, GivesTheBytesOfAStripWhateverWasBuiltBefore) {
  Worlds worlds;
  worlds.push_back(std::make_unique<const World>(Manifest{}));
  const WorldFunction& world = worlds[0]->function();
  const SystemClock clock;
  Metrics metrics;
  TerrainBuilder builder(worlds, clock, metrics, 1);
  const ColumnLoader columns = [&](const ChunkKey& key, ColumnBlock& out) {
    world.columns(chunk_columns(world, key), out);
  };
  int strips = 0;
  ColumnBlock ground;
  columns({4, 1, 0, 3}, ground);
  const auto [low_m, high_m] = std::ranges::minmax(ground.height_m);
  const auto chunk_at = [&](float height_m) {
    const double edge_m = 16 * world.cells() * world.voxel_m();
    return std::clamp(static_cast<int>(std::floor(static_cast<double>(height_m) / edge_m)), -4, 8);
  };
  const std::int32_t more = test::kIsSanitized ? 0 : 4;
  for (std::int32_t y = chunk_at(low_m) - more; y <= chunk_at(high_m) + more; ++y) {
    for (const ChunkFace face : kAllChunkFaces) {
      PayloadName name;
      name.format = PayloadFormat::kStrip;
      name.key = {4, 1, y, 3};
      name.face = face;
      const auto payload = builder.build(name, 0, CancelToken{});
      ASSERT_TRUE(payload.has_value());
      StripScratch scratch;
      ChunkMesh mesh;
      build_strip(world, name.key, face, columns, scratch, mesh);
      ASSERT_EQ(payload->bytes.empty(), mesh.indices.empty());
      if (mesh.indices.empty()) continue;
      ++strips;
      const auto lattice = protocol::strip_lattice(name.key, world.cells(), world.voxel_m());
      EXPECT_EQ(payload->bytes, *protocol::encode_draco(mesh, lattice));
      const auto decoded = protocol::decode_draco(payload->bytes, lattice);
      ASSERT_TRUE(decoded.has_value());
      EXPECT_EQ(decoded->triangles(), mesh.triangles()) << "flat triangles are kept";
    }
  }
  EXPECT_GE(strips, test::rounds(4));
  PayloadName finest;
  finest.format = PayloadFormat::kStrip;
  EXPECT_TRUE(builder.build(finest, 0, CancelToken{})->bytes.empty()) << "nothing is finer than LOD 0";
}

TEST(TerrainBuilder, MakesNothingOnceCancelled) {
  Worlds worlds;
  worlds.push_back(std::make_unique<const World>(Manifest{}));
  const SystemClock clock;
  Metrics metrics;
  TerrainBuilder builder(worlds, clock, metrics, 1);
  CancelToken token;
  token.cancel();
  EXPECT_FALSE(builder.build({}, 0, token));
}

TEST(StandingPlace, IsDryAndFlatEnoughAndNearWhereItCanBe) {
  const WorldFunction world{Manifest{}};
  for (const double at : {0.0, 12'345.0, -700'000.0, 1.0e9}) {
    const auto place = standing_place(world, {at, -at});
    if (!place) continue;
    EXPECT_GT(place->y, 2.0);
    EXPECT_LT(std::hypot(place->x - at, place->z + at), 200'000.0);
    const std::vector<glm::dvec2> around{{place->x + 1, place->z}, {place->x - 1, place->z}};
    EXPECT_NE(points_json(world, around).find("height_m"), std::string::npos);
  }
  EXPECT_TRUE(standing_place(world, {0, 0}).has_value());
}

TEST(StandingPlace, CanBeAskedForAtTheEdgeOfTheWorld) {
  const WorldFunction world{Manifest{}};
  const double edge = place_limit_m(world);
  standing_place(world, {edge, -edge});
}

TEST(WorldsJson, NamesEveryWorldAndItsHash) {
  Worlds worlds;
  worlds.push_back(std::make_unique<const World>(Manifest{}));
  EXPECT_EQ(worlds_json(worlds), "{\"worlds\":[{\"name\":\"default\",\"world_hash\":\"" + worlds[0]->hash() + "\"}]}");
  EXPECT_EQ(world_index(worlds, "default"), 0U);
  EXPECT_EQ(world_index(worlds, "other"), 1U);
}

}  // namespace
}  // namespace talus::server
