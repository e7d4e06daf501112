// SPEC.md is read by people who write clients: what it shows has to be what we send.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "protocol/limits.hpp"
#include "protocol/meshopt_codec.hpp"
#include "protocol/message.hpp"
#include "protocol/tile_codec.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::protocol {
namespace {

std::string spec() {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/protocol/SPEC.md");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The bytes of the fenced block that begins with ```hex NAME.
std::vector<std::byte> hex_block(const std::string& text, const std::string& name) {
  const std::string fence = "```hex " + name + "\n";
  const std::size_t begin = text.find(fence);
  if (begin == std::string::npos) return {};
  std::istringstream words(
      text.substr(begin + fence.size(), text.find("```", begin + fence.size()) - begin - fence.size()));
  std::vector<std::byte> out;
  for (std::string word; words >> word;) out.push_back(static_cast<std::byte>(std::stoul(word, nullptr, 16)));
  return out;
}

TEST(Spec, ShowsAChunkMessageThatDecodesToWhatItSays) {
  const std::vector<std::byte> bytes = hex_block(spec(), "chunk");
  ASSERT_EQ(bytes.size(), 79U);
  const auto decoded = decode(bytes);
  ASSERT_TRUE(decoded) << describe(decoded.error());
  const auto& chunk = std::get<ChunkHead>(decoded->message);
  EXPECT_EQ(chunk.key, (ChunkKey{2, -3, 4, -5}));
  EXPECT_EQ(chunk.revision, 6U);
  EXPECT_EQ(chunk.kind, ChunkKind::kMesh);
  ASSERT_EQ(decoded->payload.size(), 3U);
  EXPECT_EQ(decoded->payload[2], std::byte{0xCC});
}

TEST(Spec, ShowsTheBytesThatAreSent) {
  const std::vector<std::byte> bytes = hex_block(spec(), "chunk");
  const std::vector<std::byte> head = encode(ChunkHead{{2, -3, 4, -5}, 6, ChunkKind::kMesh, 3});
  ASSERT_EQ(head.size() + 3, bytes.size());
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
}

TEST(Spec, ShowsAStripMessageThatDecodesToWhatItSaysAndIsSent) {
  const std::vector<std::byte> bytes = hex_block(spec(), "strip");
  ASSERT_EQ(bytes.size(), 79U);
  const auto decoded = decode(bytes);
  ASSERT_TRUE(decoded) << describe(decoded.error());
  const auto& strip = std::get<StripHead>(decoded->message);
  EXPECT_EQ(strip.strip, (StripKey{{2, -3, 4, -5}, ChunkFace::kNy}));
  EXPECT_EQ(strip.revision, 6U);
  ASSERT_EQ(decoded->payload.size(), 3U);
  EXPECT_EQ(decoded->payload[0], std::byte{0xAA});
  const std::vector<std::byte> head = encode(strip);
  ASSERT_EQ(head.size() + 3, bytes.size());
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
}

TEST(Spec, ShowsTilesThatDecodeToWhatItSaysAndEncodeToWhatItShows) {
  const std::vector<std::byte> height_bytes = hex_block(spec(), "height");
  const auto height = decode_height(height_bytes);
  ASSERT_TRUE(height);
  EXPECT_EQ(height->key, (ChunkKey{2, -3, 0, 5}));
  EXPECT_EQ(height->tile.step_m, 1.0 / 16);
  EXPECT_EQ(height->tile.heights, (std::vector<std::int32_t>{100, 103, 110, 98, 101, -200, 97, 100, 106}));
  EXPECT_EQ(height->tile.ridges, (std::vector<std::uint8_t>{128, 130, 127, 128, 131, 0, 128, 128, 255}));
  EXPECT_EQ(height->tile.materials, (std::vector<std::uint8_t>{3, 3, 3, 3, 0, 4, 3, 1, 5}));
  EXPECT_EQ(encode_height(height->tile, height->key), height_bytes);

  const std::vector<std::byte> density_bytes = hex_block(spec(), "density");
  const auto density = decode_density(density_bytes);
  ASSERT_TRUE(density);
  EXPECT_EQ(density->key, (ChunkKey{2, -3, 4, 5}));
  EXPECT_EQ(density->tile.step_m, 1.0 / 64);
  EXPECT_EQ(density->tile.densities, (std::vector<std::int16_t>{-300, -290, -310, -301, -40, -30, 5, 200}));
  EXPECT_EQ(density->tile.materials, (std::vector<std::uint8_t>{7, 7, 8, 7, 3, 3, 255, 255}));
  EXPECT_EQ(encode_density(density->tile, density->key), density_bytes);
}

TEST(Spec, ShowsAMeshThatDecodesToWhatItSays) {
  const std::vector<std::byte> bytes = hex_block(spec(), "mesh");
  ASSERT_EQ(bytes.size(), 119U);
  const MeshLattice lattice = mesh_lattice({2, 0, 0, 0}, 2, 1.0);
  const auto mesh = decode_meshopt(bytes, lattice);
  ASSERT_TRUE(mesh);
  const std::vector<Face> faces{{{{0, 70, 0, 7, 128}, {0, 90, 64, 8, 0}, {64, 80, 0, 7, 130}}}};
  EXPECT_EQ(faces_of(*mesh), faces);
  EXPECT_EQ(encode_meshopt(*mesh, lattice), bytes);
}

TEST(Spec, NamesTheLimitsOfTheCode) {
  const std::string text = spec();
  for (const std::size_t limit : {kHeadBytesMax, kOutboundMessageBytesMax, kInboundMessageBytesMax, kKeysPerMessageMax,
                                  kWantedKeysMax, kManifestJsonBytesMax, kTokenBytesMax, kTextBytesMax}) {
    EXPECT_NE(text.find(std::to_string(limit)), std::string::npos) << limit;
  }
}

}  // namespace
}  // namespace talus::protocol
