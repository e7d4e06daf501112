#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "client_sample/cli/arguments.hpp"
#include "client_sample/cli/exit_code.hpp"
#include "client_sample/cli/map_picture.hpp"
#include "client_sample/cli/mesh_file.hpp"
#include "client_sample/cli/text.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/scratch_folder.hpp"

namespace talus::cli {
namespace {

int talus(std::vector<std::string> words) {
  words.insert(words.begin(), "talus");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return run(static_cast<int>(argv.size()), argv.data());
}

using Scratch = test::ScratchFolder;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(ChunkKeyText, IsDecimalAndInsideTheWorldOrNothing) {
  EXPECT_EQ(parse_chunk_key("0/12/3/-7"), (ChunkKey{0, 12, 3, -7}));
  EXPECT_EQ(parse_chunk_key("12/1073741823/-1073741823/0"), (ChunkKey{12, kChunkLimit, -kChunkLimit, 0}));
  for (const char* bad :
       {"", "0", "0/1/2", "0/1/2/3/4", "0/1/2/", "/0/1/2", "0/+1/2/3", "0/ 1/2/3", "0/1.5/2/3", "13/0/0/0", "-1/0/0/0",
        "0/1073741824/0/0", "0/99999999999/0/0", "0/x/0/0", "0/\xEF\xBC\x91/0/0"}) {
    EXPECT_FALSE(parse_chunk_key(bad)) << bad;
  }
  EXPECT_EQ(format_chunk_key({0, 12, 3, -7}), "0/12/3/-7");
}

TEST(PlaceText, IsThreeFiniteNumbersOrNothing) {
  EXPECT_EQ(parse_place("1,-2.5,1e9"), (glm::dvec3{1, -2.5, 1e9}));
  for (const char* bad : {"", "1,2", "1,2,3,4", "nan,0,0", "0,inf,0", "1e999,0,0", "1, 2,3", "a,b,c"}) {
    EXPECT_FALSE(parse_place(bad)) << bad;
  }
}

TEST(JsonText, EscapesWhatHasToBe) {
  EXPECT_EQ(json_string("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
}

ChunkMesh triangle() {
  ChunkMesh mesh;
  mesh.positions = {{0, 0, 0}, {64, 0, 0}, {0, 0, 64}};
  mesh.normals.assign(3, {0, 1, 0});
  mesh.materials = {3, 5, 200};
  mesh.ridges = {1, 2, 3};
  mesh.indices = {0, 2, 1};
  return mesh;
}

TEST(MeshFile, WritesObjInWorldMetresToTheLastDigit) {
  const std::string obj = encode_obj(triangle(), protocol::mesh_lattice({0, 0, 0, 0}, 32, 1.0), {1e9, 2, -3});
  EXPECT_THAT(obj, testing::HasSubstr("\nv 1000000001"));
  EXPECT_THAT(obj, testing::HasSubstr("vn 0.00000 1.00000 0.00000\n"));
  EXPECT_THAT(obj, testing::HasSubstr("f 1//1 3//3 2//2\n"));
}

TEST(MeshFile, WritesPlyAsLongAsItsHeadSays) {
  const std::string ply = encode_ply(triangle(), protocol::mesh_lattice({0, 0, 0, 0}, 32, 1.0), {0, 0, 0});
  const std::string end = "end_header\n";
  const std::size_t body = ply.find(end) + end.size();
  EXPECT_EQ(ply.size() - body, 3U * (3 * 8 + 3 * 4 + 5) + 13U);
  double x = 0;
  std::memcpy(&x, ply.data() + body + 41, sizeof x);
  EXPECT_EQ(x, 1.0);
}

TEST(Cli, WritesALocalChunkInEveryFormat) {
  const Scratch scratch;
  for (const char* name : {"c.drc", "c.glb", "c.obj", "c.ply"}) {
    EXPECT_EQ(talus({"get", "12/0/0/0", "-o", scratch / name, "--local"}), kDone) << name;
    EXPECT_GT(content(scratch / name).size(), 500U) << name;
  }
  // At the coarsest LOD all land lies between two layers of samples, the lower one at the sea.
  for (const char* name : {"c.density", "c.height"}) {
    EXPECT_EQ(talus({"get", "10/0/0/0", "-o", scratch / name, "--local"}), kDone) << name;
    EXPECT_GT(content(scratch / name).size(), 500U) << name;
  }
  EXPECT_EQ(content(scratch / "c.height").substr(0, 4), "tlsh");
  EXPECT_EQ(content(scratch / "c.density").substr(0, 4), "tlsd");
  EXPECT_EQ(content(scratch / "c.glb").substr(0, 4), "glTF");
  EXPECT_EQ(content(scratch / "c.drc").substr(0, 5), "DRACO");
}

TEST(Cli, SaysByItsExitCodeWhatWentWrong) {
  const Scratch scratch;
  const std::string out = scratch / "c.drc";
  EXPECT_EQ(talus({"get", "0/0/1000/0", "-o", out, "--local"}), kNoSurface);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(talus({"get", "0/0/0", "-o", out, "--local"}), kUsage);
  EXPECT_EQ(talus({"get", "0/0/0/0", "-o", scratch / "c.stl", "--local"}), kUsage);
  EXPECT_EQ(talus({"get", "12/0/0/0", "-o", scratch / "no/such/folder.drc", "--local"}), kFailed);
  EXPECT_EQ(talus({"get", "0/0/0/0", "-o", out, "--manifest", "x"}), kUsage) << "--manifest needs --local";
  EXPECT_EQ(talus({"info", "--server", "ftp://x"}), kUsage);
  EXPECT_EQ(talus({"info", "--world", "../etc"}), kUsage);
  EXPECT_EQ(talus({"fly", "--from", "1,2"}), kUsage);
  EXPECT_EQ(talus({"fly", "--viewers", "0"}), kUsage);
  EXPECT_EQ(talus({}), kUsage);
  EXPECT_EQ(talus({"frobnicate"}), kUsage);
  EXPECT_EQ(talus({"--help"}), kDone);
}

/// What a command prints on standard output.
std::string said(const std::vector<std::string>& words, int code) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(talus(words), code);
  std::fflush(stdout);
  return testing::internal::GetCapturedStdout();
}

TEST(Cli, ExplainsOneParameterOrOneSection) {
  const std::string gain = said({"manifest", "explain", "erosion.gain"}, kDone);
  EXPECT_EQ(std::ranges::count(gain, '\n'), 4);
  EXPECT_THAT(gain, testing::HasSubstr("0.1..0.9, default 0.5\ngain = 0.5\n"));
  const std::string section = said({"manifest", "explain", "cover"}, kDone);
  EXPECT_THAT(section, testing::HasSubstr("snow_line_m = "));
  EXPECT_THAT(section, testing::Not(testing::HasSubstr("[erosion]")));
  EXPECT_EQ(talus({"manifest", "explain", "erosion.gian"}), kUsage);
}

TEST(Cli, SaysWhatTwoWorldsDifferIn) {
  const Scratch scratch;
  std::ofstream(scratch / "a.toml") << "name = \"a\"\n";
  std::ofstream(scratch / "b.toml") << "name = \"a\"\nseed = 5\n[cover]\nsnow_line_m = 700.5\n";
  const std::string text = said({"manifest", "diff", scratch / "a.toml", scratch / "b.toml"}, kDone);
  EXPECT_EQ(std::ranges::count(text, '\n'), 2);
  EXPECT_THAT(text, testing::ContainsRegex("cover.snow_line_m +1050 -> 700.5 m\n"));
  EXPECT_THAT(text, testing::ContainsRegex("seed +20261466 -> 5\n"));
  EXPECT_THAT(said({"manifest", "diff", scratch / "a.toml", scratch / "a.toml"}, kDone),
              testing::HasSubstr("same world"));
  EXPECT_EQ(talus({"manifest", "diff", scratch / "a.toml", scratch / "absent.toml"}), kFailed);
}

TEST(Cli, DrawsMapsOfAnySquareAndSize) {
  const Scratch scratch;
  const std::string out = scratch / "m.png";
  for (const char* area : {"0,0,64", "-1e9,1e9,0.05", "1234.5,-77.25,3.3"}) {
    EXPECT_EQ(talus({"map", "--area", area, "--size", "100", "-o", out}), kDone) << area;
    EXPECT_EQ(content(out).substr(1, 3), "PNG") << area;
  }
  for (const char* area : {"", "0,0", "0,0,0", "0,0,5000", "2e10,0,1", "nan,0,1"}) {
    EXPECT_EQ(talus({"map", "--area", area, "-o", out}), kUsage) << area;
  }
  EXPECT_EQ(talus({"map", "--area", "0,0,1", "--layer", "shadow", "-o", out}), kUsage);
  EXPECT_EQ(talus({"map", "--area", "0,0,1", "--size", "16", "-o", scratch / "no/such/folder.png"}), kFailed);
  EXPECT_EQ(talus({"map", "--area", "0,0,1", "-o", out, "--world", scratch / "absent.toml"}), kFailed);
}

TEST(Cli, DrawsSectionsOfAnyLine) {
  const Scratch scratch;
  const std::string out = scratch / "s.png";
  EXPECT_EQ(talus({"section", "--from", "-200,0", "--to", "150.5,90", "--size", "90x64", "-o", out}), kDone);
  EXPECT_EQ(content(out).substr(1, 3), "PNG");
  EXPECT_EQ(talus({"section", "--from", "0,0", "--to", "9e5,0", "--size", "64x64", "--heights", "-100,900", "-o", out}),
            kDone);
  for (const char* to : {"0,0", "1,1", "1", "1,2,3", "nan,5", "2e6,0", "2e10,0"}) {
    EXPECT_EQ(talus({"section", "--from", "0,0", "--to", to, "-o", out}), kUsage) << to;
  }
  for (const char* size : {"0x64", "64", "64x9000", "axb", "-64x64"}) {
    EXPECT_EQ(talus({"section", "--from", "0,0", "--to", "100,0", "--size", size, "-o", out}), kUsage) << size;
  }
  EXPECT_EQ(talus({"section", "--from", "0,0", "--to", "100,0", "--heights", "5,5", "-o", out}), kUsage);
}

TEST(Cli, DrawsACliffAsItIsSeenFromTheSea) {
  const Scratch scratch;
  const std::string out = scratch / "v.png";
  EXPECT_EQ(talus({"view", "--at", "4845,24,39280", "--yaw", "200", "--size", "24x16", "-o", out}), kDone);
  EXPECT_EQ(content(out).substr(1, 3), "PNG");
  for (const char* at : {"0,0", "0,nan,0", "2e9,0,0", "0,9000,0"}) {
    EXPECT_EQ(talus({"view", "--at", at, "-o", out}), kUsage) << at;
  }
  EXPECT_EQ(talus({"view", "--at", "0,0,0", "--size", "8x9", "-o", out}), kUsage);
  EXPECT_EQ(talus({"view", "--at", "0,0,0", "--width", "900", "-o", out}), kUsage);
}

TEST(Cli, SurveysASquareAsATableOrAsJson) {
  const std::string table = said({"survey", "--area", "0,0,0.1", "--coast", "0"}, kDone);
  EXPECT_THAT(table, testing::HasSubstr("\nland "));
  const char* area = test::kIsSanitized ? "0,0,0.3" : "0,0,2";
  const std::string json = said({"survey", "--area", area, "--coast", "1", "--json"}, kDone);
  EXPECT_TRUE(json.starts_with("{\"world\":\"default\"")) << json.substr(0, 60);
  EXPECT_TRUE(json.ends_with("]}\n")) << json;
  EXPECT_EQ(std::ranges::count(json, '{'), std::ranges::count(json, '}'));
  EXPECT_EQ(talus({"survey", "--area", "0,0"}), kUsage);
}

TEST(Cli, DrawsAGalleryOfSmallFiles) {
  const Scratch scratch;
  EXPECT_EQ(talus({"gallery", scratch / "", "--size", "64", "--only", "scales"}), kDone);
  EXPECT_EQ(content(scratch / "scales.png").substr(1, 3), "PNG");
  EXPECT_EQ(content(scratch / "octaves.png"), "") << "nobody asked for it";
  EXPECT_EQ(talus({"gallery", scratch / "", "--only", "scale"}), kUsage);
  // Its cliffs are drawn as `talus view` draws them.
  if (!test::kIsSanitized) {
    EXPECT_EQ(talus({"gallery", scratch / "", "--size", "64"}), kDone);
  }
  EXPECT_EQ(talus({"gallery", scratch / "absent", "--size", "64"}), kFailed);
  EXPECT_EQ(talus({"gallery", scratch / "", "--size", "64", "--worlds", scratch / "absent"}), kFailed);
}

TEST(MapPicture, IsTheLatticeItselfWherePixelsFitIt) {
  const WorldFunction world{Manifest()};
  const Picture picture = draw_picture(world, {{512, 512}, 1024}, 64, {});
  MapScratch scratch;
  std::vector<std::uint8_t> raster(picture.rgb.size());
  draw_map(world, {0, 0, 16, 2, 64, 64}, {}, scratch, raster);
  EXPECT_EQ(picture.rgb, raster);
}

TEST(Cli, ChecksAndExplainsManifests) {
  const Scratch scratch;
  std::ofstream(scratch / "good.toml") << "name = \"alps\"\n";
  std::ofstream(scratch / "bad.toml") << "nmae = \"alps\"\n";
  EXPECT_EQ(talus({"manifest", "check", scratch / "good.toml"}), kDone);
  EXPECT_EQ(talus({"manifest", "check", scratch / "bad.toml"}), kBadManifest);
  EXPECT_EQ(talus({"manifest", "check", scratch / "absent.toml"}), kFailed);
  EXPECT_EQ(talus({"manifest", "explain"}), kDone);
  EXPECT_EQ(talus({"manifest", "explain", "--world", scratch / "bad.toml"}), kBadManifest);
  EXPECT_EQ(talus({"get", "12/0/0/0", "-o", scratch / "c.drc", "--local", "--manifest", scratch / "bad.toml"}),
            kBadManifest);
}

}  // namespace
}  // namespace talus::cli
