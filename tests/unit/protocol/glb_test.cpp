#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include <nlohmann/json.hpp>

#include "protocol/mesh_codec.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::protocol {
namespace {

std::vector<std::byte> encoded(const ChunkMesh& mesh, const glm::dvec3& translation_m) {
  const GlbPart part{mesh, kUnit, translation_m};
  return *encode_glb(std::span(&part, 1), {0, 1, 2, 3});
}

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
  const auto glb = encoded(sample_surface(32, 1), {1, 2, 3});
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
  const auto json = json_of(encoded(mesh, {}));
  const auto decoded = decode_draco(*encode_draco(mesh, kUnit), kUnit);
  EXPECT_GT(decoded->positions.size(), mesh.positions.size());
  EXPECT_EQ(json["accessors"][1]["count"], decoded->positions.size());
  EXPECT_EQ(json["accessors"][0]["count"], decoded->indices.size());
  EXPECT_EQ(json["accessors"][1]["min"], nlohmann::json({900 / 64.0, 900 / 64.0, 900 / 64.0}));
  EXPECT_EQ(json["accessors"][1]["max"], nlohmann::json({1100 / 64.0, 1100 / 64.0, 1100 / 64.0}));
}

TEST(Glb, StandsWhereItIsToldTo) {
  const auto json = json_of(encoded(sample_surface(32, 1), {1e9, -2.5, 3}));
  EXPECT_EQ(json["nodes"][0]["translation"], nlohmann::json({1e9, -2.5, 3.0}));
  EXPECT_EQ(json["extensionsRequired"], nlohmann::json({"KHR_draco_mesh_compression"}));
}

TEST(Glb, HoldsPartAfterPartAndSaysWhoseTheyAre) {
  const ChunkMesh mesh = sample_surface(32, 1);
  const std::array<GlbPart, 3> parts{GlbPart{mesh, kUnit, {0, 0, 0}}, GlbPart{ChunkMesh{}, kUnit, {0, 32, 0}},
                                     GlbPart{sample_pinched_tetrahedra(), kUnit, {0, 64, 0}}};
  const auto glb = *encode_glb(parts, {4, -1, 0, 2});
  const auto json = json_of(glb);
  ASSERT_EQ(json["nodes"].size(), 2U) << "the empty part has no node";
  EXPECT_EQ(json["nodes"][1]["translation"], nlohmann::json({0.0, 64.0, 0.0}));
  EXPECT_EQ(json["nodes"][1]["extras"], nlohmann::json({{"lod", 4}, {"x", -1}, {"y", 0}, {"z", 2}}));
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["indices"], 6);
  const std::size_t binary = 28 + u32_at(glb, 12);
  for (const auto& view : json["bufferViews"]) {
    EXPECT_EQ(std::memcmp(glb.data() + binary + view["byteOffset"].get<std::size_t>(), "DRACO", 5), 0);
  }
}

TEST(Glb, OfNothingIsAnEmptyScene) {
  const auto glb = encoded({}, {});
  EXPECT_EQ(u32_at(glb, 8), glb.size());
  const auto json = json_of(glb);
  EXPECT_FALSE(json.contains("meshes"));
  EXPECT_EQ(json["scenes"].size(), 1U);
}

}  // namespace
}  // namespace talus::protocol
