#include <gtest/gtest.h>

#include <cstring>

#include <nlohmann/json.hpp>

#include "protocol/mesh_codec.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::protocol {
namespace {

const MeshLattice kUnit = mesh_lattice({0, 0, 0, 0}, 32, 1.0);

std::uint32_t u32_at(const std::vector<std::byte>& bytes, std::size_t at) {
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data() + at, 4);
  return out;
}

nlohmann::json json_of(const std::vector<std::byte>& glb) {
  const std::string text(reinterpret_cast<const char*>(glb.data()) + 20, u32_at(glb, 12));
  return nlohmann::json::parse(text);
}

TEST(Glb, IsAContainerWhoseLengthsAddUp) {
  const auto glb = *encode_glb(sample_surface(32, 1), kUnit, {1, 2, 3});
  EXPECT_EQ(std::memcmp(glb.data(), "glTF", 4), 0);
  EXPECT_EQ(u32_at(glb, 4), 2U);
  EXPECT_EQ(u32_at(glb, 8), glb.size());
  const std::size_t binary = 20 + u32_at(glb, 12);
  EXPECT_EQ(binary % 4, 0U);
  EXPECT_EQ(std::memcmp(glb.data() + binary + 4, "BIN\0", 4), 0);
  EXPECT_EQ(binary + 8 + u32_at(glb, binary), glb.size());
  EXPECT_EQ(std::memcmp(glb.data() + binary + 8, "DRACO", 5), 0);
}

TEST(Glb, DeclaresTheCountsAndBoundsOfTheDecodedMesh) {
  // Seven vertices are shared by shells that Draco splits: the asset has to say how many there are after that.
  const ChunkMesh mesh = sample_pinched_tetrahedra();
  const auto json = json_of(*encode_glb(mesh, kUnit, {}));
  const auto decoded = decode_draco(*encode_draco(mesh, kUnit), kUnit);
  EXPECT_GT(decoded->positions.size(), mesh.positions.size());
  EXPECT_EQ(json["accessors"][1]["count"], decoded->positions.size());
  EXPECT_EQ(json["accessors"][0]["count"], decoded->indices.size());
  EXPECT_EQ(json["accessors"][1]["min"], nlohmann::json({900 / 64.0, 900 / 64.0, 900 / 64.0}));
  EXPECT_EQ(json["accessors"][1]["max"], nlohmann::json({1100 / 64.0, 1100 / 64.0, 1100 / 64.0}));
}

TEST(Glb, StandsWhereItIsToldTo) {
  const auto json = json_of(*encode_glb(sample_surface(32, 1), kUnit, {1e9, -2.5, 3}));
  EXPECT_EQ(json["nodes"][0]["translation"], nlohmann::json({1e9, -2.5, 3.0}));
  EXPECT_EQ(json["extensionsRequired"], nlohmann::json({"KHR_draco_mesh_compression"}));
}

TEST(Glb, OfNothingIsAnEmptyScene) {
  const auto glb = *encode_glb({}, kUnit, {});
  EXPECT_EQ(u32_at(glb, 8), glb.size());
  const auto json = json_of(glb);
  EXPECT_FALSE(json.contains("meshes"));
  EXPECT_EQ(json["scenes"].size(), 1U);
}

}  // namespace
}  // namespace talus::protocol
