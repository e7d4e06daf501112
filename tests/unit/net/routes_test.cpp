#include "server/net/routes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <utility>

#include "server/net/url_text.hpp"

namespace talus::server {
namespace {

class Routes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    worlds_ = new Worlds;
    worlds_->push_back(std::make_unique<const World>(Manifest{}));
  }
  static void TearDownTestSuite() { delete worlds_; }

  static Route resolve_target(std::string_view path, std::string_view query = {}, HttpMethod method = HttpMethod::kGet,
                              std::string_view if_none_match = {}, Door door = Door::kPublic) {
    HttpRequest request;
    request.method = method;
    request.path = path;
    request.query = query;
    if (!if_none_match.empty()) {
      request.fields.push({"If-None-Match", if_none_match});
    }
    static const StaticFiles kFiles;
    static const std::string kList = "{}";
    return resolve(request, {*worlds_, kFiles, kList, door, true});
  }

  static const HttpAnswer* answer_in(const Route& route) {
    const auto* answered = std::get_if<AnswerRoute>(&route);
    return answered == nullptr ? nullptr : &answered->answer;
  }

  static Worlds* worlds_;
};
Worlds* Routes::worlds_ = nullptr;

TEST_F(Routes, ReadAChunksKeyAndFormat) {
  const Route route = resolve_target("/v1/worlds/default/chunks/3/-4/0/1073741823.drc");
  const auto* chunk = std::get_if<ChunkRoute>(&route);
  ASSERT_NE(chunk, nullptr);
  EXPECT_EQ(chunk->name.key, (ChunkKey{3, -4, 0, 1'073'741'823}));
  EXPECT_EQ(chunk->name.format, PayloadFormat::kDraco);
  const Route glb = resolve_target("/v1/worlds/default/chunks/0/1/2/3.glb", "origin=1.5,-2e3,0");
  EXPECT_EQ(std::get<ChunkRoute>(glb).name.origin, glm::dvec3(1.5, -2000.0, 0.0));
}

TEST_F(Routes, ReadAMapTile) {
  const Route route = resolve_target("/v1/worlds/default/map/5/-4/7.png");
  const auto* tile = std::get_if<ChunkRoute>(&route);
  ASSERT_NE(tile, nullptr);
  EXPECT_EQ(tile->name.format, PayloadFormat::kMap);
  EXPECT_EQ(tile->name.key, (ChunkKey{5, -4, 0, 7}));
}

TEST_F(Routes, ReadTheLayerOfAMapTileAndGiveEachAnETagOfItsOwn) {
  const World& world = *(*worlds_)[0];
  std::set<std::string> etags;
  for (std::size_t n = 0; n < kMapLayerNames.size(); ++n) {
    const std::string layer = "layer=" + std::string(kMapLayerNames[n]);
    const Route route = resolve_target("/v1/worlds/default/map/5/-4/7.png", layer);
    const auto* tile = std::get_if<ChunkRoute>(&route);
    ASSERT_NE(tile, nullptr) << layer;
    EXPECT_EQ(tile->name.layer, static_cast<MapLayer>(n));
    etags.insert(world.etag(tile->name));
  }
  EXPECT_EQ(etags.size(), kMapLayerNames.size());
  EXPECT_TRUE(etags.contains(world.etag(PayloadFormat::kMap))) << "without a layer it is the shaded one";
  for (const char* bad : {"layer=", "layer=Plates", "layer=plates&layer=plates", "layer=%zz", "layer=snow"}) {
    const Route route = resolve_target("/v1/worlds/default/map/5/-4/7.png", bad);
    const auto* answer = std::get_if<AnswerRoute>(&route);
    ASSERT_NE(answer, nullptr) << bad;
    EXPECT_EQ(answer->answer.status, 400) << bad;
    EXPECT_NE(answer->answer.text.find("bad_layer"), std::string::npos);
    EXPECT_NE(answer->answer.text.find("districts"), std::string::npos) << "the words that there are";
  }
}

TEST_F(Routes, ReadTheOtherFormatsOfChunksAndColumns) {
  const Route density = resolve_target("/v1/worlds/default/chunks/3/-4/5/6.density", "rev=0");
  EXPECT_EQ(std::get<ChunkRoute>(density).name.key, (ChunkKey{3, -4, 5, 6}));
  EXPECT_EQ(std::get<ChunkRoute>(density).name.format, PayloadFormat::kDensity);
  const Route height = resolve_target("/v1/worlds/default/columns/12/-4/6.height");
  EXPECT_EQ(std::get<ChunkRoute>(height).name.key, (ChunkKey{12, -4, 0, 6}));
  EXPECT_EQ(std::get<ChunkRoute>(height).name.format, PayloadFormat::kHeight);
}

TEST_F(Routes, ReadTilesOfTheWorldAndOfAColumn) {
  // The world's middle is the corner that the four tiles of level 1 share; 3D Tiles count y against z.
  const Route world = resolve_target("/v1/worlds/default/3dtiles/world/29/268435456/268435455.glb");
  EXPECT_EQ(std::get<ChunkRoute>(world).name.key, (ChunkKey{0, 0, 0, 0}));
  EXPECT_EQ(std::get<ChunkRoute>(world).name.format, PayloadFormat::kTile);
  const Route column = resolve_target("/v1/worlds/default/3dtiles/6/-3/4/2/0/1.glb", "origin=1,2,3");
  EXPECT_EQ(std::get<ChunkRoute>(column).name.key, (ChunkKey{4, -12, 0, 18}));
  EXPECT_EQ(std::get<ChunkRoute>(column).name.origin, glm::dvec3(1, 2, 3));
  const Route subtree = resolve_target("/v1/worlds/default/3dtiles/6/-3/4/5/31/0.subtree");
  EXPECT_EQ(answer_in(subtree)->status, 200);
  EXPECT_EQ(answer_in(subtree)->text.substr(0, 4), "subt");
  const Route local = resolve_target("/v1/worlds/default/3dtiles/tileset.json", "origin=1e6,-5&km=4");
  EXPECT_EQ(std::get<TilesetRoute>(local).place.origin_m, glm::dvec2(1e6, -5)) << "the pool looks at its ground";
  EXPECT_EQ(std::get<TilesetRoute>(local).place.km, 4.0);
  const std::string& etag = (*worlds_)[0]->tileset_etag();
  const Route known = resolve_target("/v1/worlds/default/3dtiles/tileset.json", "", HttpMethod::kGet, etag);
  EXPECT_EQ(answer_in(known)->status, 304);
}

TEST_F(Routes, NameTheFieldOfEveryMalformedCoordinate) {
  for (const std::string_view bad : {"2147483648", "-2147483649", "9007199254740992",
                                     "1073741824", "1e300",       "1.0",
                                     "NaN",        "inf",         "",
                                     "+1",         "01",          "-0",
                                     "-01",        " 1",          "1 ",
                                     "0x1",        "１",          "%31",
                                     "1%00",       "--1",         "-",
                                     "1_0"}) {
    const std::string text(bad);
    const std::vector<std::pair<std::string, std::string>> kPlaces{{"bad_lod", "/" + text + "/0/0/0.drc"},
                                                                   {"bad_x", "/0/" + text + "/0/0.drc"},
                                                                   {"bad_y", "/0/0/" + text + "/0.drc"},
                                                                   {"bad_z", "/0/0/0/" + text + ".glb"}};
    for (const auto& [code, path] : kPlaces) {
      const Route route = resolve_target("/v1/worlds/default/chunks" + path);
      const HttpAnswer* answer = answer_in(route);
      ASSERT_NE(answer, nullptr) << path;
      EXPECT_EQ(answer->status, 400) << path;
      EXPECT_NE(answer->text.find("\"" + code + "\""), std::string::npos) << path << " -> " << answer->text;
    }
  }
}

TEST_F(Routes, ReadTheFaceOfASeamStrip) {
  const Route route = resolve_target("/v1/worlds/default/seams/3/-4/0/7/nz.drc");
  const auto* strip = std::get_if<ChunkRoute>(&route);
  ASSERT_NE(strip, nullptr);
  EXPECT_EQ(strip->name.key, (ChunkKey{3, -4, 0, 7}));
  EXPECT_EQ(strip->name.format, PayloadFormat::kStrip);
  EXPECT_EQ(strip->name.face, ChunkFace::kNz);
  const std::string& etag = (*worlds_)[0]->etag(PayloadFormat::kStrip);
  EXPECT_NE(etag, (*worlds_)[0]->etag(PayloadFormat::kDraco));
  const Route known = resolve_target("/v1/worlds/default/seams/3/-4/0/7/nz.drc", "", HttpMethod::kGet, etag);
  ASSERT_NE(answer_in(known), nullptr);
  EXPECT_EQ(answer_in(known)->status, 304);
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kBad{{{"bad_seam", "3/0/0/0"},
                                                                               {"bad_seam", "3/0/0/0/px.drc/1"},
                                                                               {"bad_format", "3/0/0/0/px"},
                                                                               {"bad_format", "3/0/0/0/px.glb"},
                                                                               {"bad_face", "3/0/0/0/top.drc"},
                                                                               {"bad_face", "3/0/0/0/PX.drc"},
                                                                               {"bad_face", "3/0/0/0/.drc"},
                                                                               {"bad_lod", "13/0/0/0/px.drc"},
                                                                               {"bad_z", "3/0/0/1073741824/px.drc"}}};
  for (const auto& [code, path] : kBad) {
    const Route bad = resolve_target("/v1/worlds/default/seams/" + std::string(path));
    ASSERT_NE(answer_in(bad), nullptr) << path;
    EXPECT_EQ(answer_in(bad)->status, 400) << path;
    EXPECT_NE(answer_in(bad)->text.find("\"" + std::string(code) + "\""), std::string::npos) << answer_in(bad)->text;
  }
}

TEST_F(Routes, AnswerWithTheStatusTheDoorsPromise) {
  struct Case {
    std::string_view path;
    std::string_view query;
    HttpMethod method;
    int status;
  };
  constexpr std::array<Case, 76> kTable{{
      {"/healthz", "", HttpMethod::kGet, 200},
      {"/readyz", "", HttpMethod::kHead, 200},
      {"/v1/worlds", "", HttpMethod::kGet, 200},
      {"/v1/worlds/default", "", HttpMethod::kGet, 200},
      {"/", "", HttpMethod::kGet, 404},
      {"/nothing", "", HttpMethod::kGet, 404},
      {"/../../etc/passwd", "", HttpMethod::kGet, 404},
      {"/v1", "", HttpMethod::kGet, 404},
      {"/v1/", "", HttpMethod::kGet, 404},
      {"/v1/worlds/", "", HttpMethod::kGet, 404},
      {"/v1/worlds/other", "", HttpMethod::kGet, 404},
      {"/v1/worlds/other/chunks/a/b/c/d", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/nothing", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/chunks", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0/0", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0/0.jpg", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0/0/0.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/12/0/0.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/-1/0/0.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/65536/0.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0/-65537.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/01/0.png", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/map/0/0/0.png", "", HttpMethod::kOther, 405},
      {"/v1/worlds/default/chunks/0/0/0/0", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.obj", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0/0.drc", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.glb", "origin=1,2", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.glb", "origin=1,2,nan", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.glb", "origin=1,2,3&origin=1,2,3", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/13/0/0/0.drc", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/spawn", "near=1e300,0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/points", "xz=0,0;", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,0&dir=0,0,0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,1e300&dir=0,1,0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,0&dir=0,1,0&max=10001", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,0&dir=0,1,0&max=0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/ray", "from=0,0,0&dir=0,1,0&max=nan", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.drc", "rev=-1", HttpMethod::kGet, 400},
      {"/v1/worlds/default/chunks/0/0/0/0.density", "rev=x", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/tileset.json", "", HttpMethod::kGet, 200},
      {"/v1/worlds/default/3dtiles/tileset.json", "lat=47&lon=11", HttpMethod::kHead, 200},
      {"/v1/worlds/default/3dtiles/tileset.json", "origin=1", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "origin=0,1e12", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "km=4", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "origin=0,0&km=0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "origin=0,0&km=65", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "lat=47", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "lon=11", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "lat=91&lon=0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "lat=0&lon=x", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/world/5/0/0.subtree", "", HttpMethod::kGet, 200},
      {"/v1/worlds/default/3dtiles/world/4/0/0.subtree", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/world/30/0/0.subtree", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/world/5/32/0.subtree", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/world/5/-1/0.subtree", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/world/16/0/0.glb", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/6/0/0/7/0/0.glb", "", HttpMethod::kGet, 404},
      {"/v1/worlds/default/3dtiles/6/0/0/0/0/0.glb", "origin=0,0", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/13/0/0/0/0/0.glb", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/6/0/0/0/0/0.b3dm", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/3dtiles/tileset.json", "", HttpMethod::kOther, 405},
      {"/v1/worlds/default/columns", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/0/0/0", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/0/0/0/0.height", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/13/0/0.height", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/0/1073741824/0.height", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/0/0/x.height", "", HttpMethod::kGet, 400},
      {"/v1/worlds/default/columns/0/0/0.height", "", HttpMethod::kOther, 405},
      {"/v1/worlds/default/chunks/0/0/0/0.drc", "", HttpMethod::kOther, 405},
      {"/v1/worlds/default/chunks/0/0/0/0.drc", "", HttpMethod::kOptions, 204},
      {"", "", HttpMethod::kOptions, 204},
  }};
  for (const Case& c : kTable) {
    const Route route = resolve_target(c.path, c.query, c.method);
    const HttpAnswer* answer = answer_in(route);
    ASSERT_NE(answer, nullptr) << c.path;
    EXPECT_EQ(answer->status, c.status) << c.path << "?" << c.query;
    EXPECT_EQ(answer->text.starts_with("{\"error\":\""), c.status >= 400) << answer->text;
    EXPECT_EQ(answer->fields.find("Allow: GET, HEAD, OPTIONS") != std::string_view::npos,
              c.status == 405 || c.method == HttpMethod::kOptions);
  }
}

TEST_F(Routes, SayNotModifiedWithoutAskingForTheChunk) {
  const std::string& etag = (*worlds_)[0]->etag(PayloadFormat::kDraco);
  for (const std::string& value : {etag, "W/" + etag, "\"a\", " + etag, std::string("*")}) {
    const Route route = resolve_target("/v1/worlds/default/chunks/0/0/0/0.drc", "", HttpMethod::kGet, value);
    ASSERT_NE(answer_in(route), nullptr) << value;
    EXPECT_EQ(answer_in(route)->status, 304);
  }
  const Route other = resolve_target("/v1/worlds/default/chunks/0/0/0/0.glb", "", HttpMethod::kGet, etag);
  EXPECT_TRUE(std::holds_alternative<ChunkRoute>(other)) << "another format has another tag";
}

TEST_F(Routes, KeepMetricsBehindTheAdminDoor) {
  EXPECT_EQ(answer_in(resolve_target("/metrics"))->status, 404);
  const Route admin = resolve_target("/metrics", "", HttpMethod::kGet, "", Door::kAdmin);
  EXPECT_TRUE(std::holds_alternative<MetricsRoute>(admin));
  const Route world = resolve_target("/v1/worlds", "", HttpMethod::kGet, "", Door::kAdmin);
  EXPECT_EQ(answer_in(world)->status, 404);
}

TEST_F(Routes, TakeAtMostAThousandPoints) {
  std::string xz = "xz=1,1";
  for (int i = 1; i < 1000; ++i) xz += ";1,1";
  EXPECT_TRUE(std::holds_alternative<PointsRoute>(resolve_target("/v1/worlds/default/points", xz)));
  const Route more = resolve_target("/v1/worlds/default/points", xz + ";1,1");
  EXPECT_EQ(answer_in(more)->status, 400);
}

TEST_F(Routes, ReadEscapesInQueriesOnly) {
  const Route route = resolve_target("/v1/worlds/default/spawn", "near=10%2C-20");
  ASSERT_TRUE(std::holds_alternative<SpawnRoute>(route));
  EXPECT_EQ(std::get<SpawnRoute>(route).near_m, glm::dvec2(10, -20));
  EXPECT_FALSE(percent_decoded("%4"));
  EXPECT_FALSE(percent_decoded("%zz"));
  EXPECT_EQ(percent_decoded("a%41"), "aA");
}

}  // namespace
}  // namespace talus::server
