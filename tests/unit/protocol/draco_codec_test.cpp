#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "protocol/limits.hpp"
#include "protocol/mesh_codec.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::protocol {
namespace {

TEST(DracoCodec, GivesBackEveryTriangleAtItsExactPlace) {
  for (const int speed : {0, 3, 5, 7, 10}) {
    for (const int cells : {16, 32}) {
      const ChunkMesh mesh = sample_surface(cells, 7);
      const MeshLattice lattice = mesh_lattice({3, 0, 0, 0}, cells, 0.5);
      const auto bytes = encode_draco(mesh, lattice, speed);
      ASSERT_TRUE(bytes);
      const auto decoded = decode_draco(*bytes, lattice);
      ASSERT_TRUE(decoded) << speed;
      EXPECT_EQ(faces_of(*decoded), faces_of(mesh)) << "speed " << speed << ", cells " << cells;
    }
  }
}

TEST(DracoCodec, IsExactAtEveryLodAndVoxelSize) {
  const ChunkMesh mesh = sample_surface(32, 1);
  for (int lod = 0; lod <= kLodMax; ++lod) {
    for (const double voxel_m : {0.25, 1.0, 4.0}) {
      const MeshLattice lattice = mesh_lattice({lod, 0, 0, 0}, 32, voxel_m);
      const auto decoded = decode_draco(*encode_draco(mesh, lattice), lattice);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(faces_of(*decoded), faces_of(mesh)) << lod << " " << voxel_m;
    }
  }
}

TEST(DracoCodec, KeepsBothEndsOfTheLattice) {
  ChunkMesh mesh;
  mesh.positions = {{0, 0, 0}, {2048, 0, 0}, {2048, 2048, 2048}};
  mesh.normals.assign(3, glm::vec3(0, 1, 0));
  mesh.materials = {0, 6, 255};
  mesh.ridges = {0, 128, 255};
  mesh.indices = {0, 1, 2};
  const auto decoded = decode_draco(*encode_draco(mesh, kUnit), kUnit);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(faces_of(*decoded), faces_of(mesh));
}

TEST(DracoCodec, KeepsNormalsWithinTheirQuantisation) {
  const ChunkMesh mesh = sample_surface(32, 3);
  const auto decoded = decode_draco(*encode_draco(mesh, kUnit), kUnit);
  ASSERT_TRUE(decoded);
  std::map<std::array<int, 3>, glm::vec3> normals;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    normals[{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z}] = mesh.normals[i];
  }
  for (std::size_t i = 0; i < decoded->positions.size(); ++i) {
    const glm::u16vec3 p = decoded->positions[i];
    const glm::vec3 n = decoded->normals[i];
    const glm::vec3 was = normals.at({p.x, p.y, p.z});
    // 8 bits across the octahedron: at most about one degree.
    EXPECT_GT(n.x * was.x + n.y * was.y + n.z * was.z, std::cos(0.02F));
    EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0F, 1e-5F);
  }
}

TEST(DracoCodec, GivesSharedNormalsTheSameBitsInEveryChunk) {
  // A border vertex has the same normal in both chunks but different neighbours: prediction must not show.
  const ChunkMesh a = sample_surface(32, 3);
  ChunkMesh b;
  b.positions = {a.positions[5], {0, 0, 0}, {64, 64, 0}};
  b.normals = {a.normals[5], {0, 1, 0}, {1, 0, 0}};
  b.materials.assign(3, 0);
  b.ridges.assign(3, 0);
  b.indices = {0, 1, 2};
  const auto normal_at = [](const ChunkMesh& mesh, glm::u16vec3 position) {
    const auto at = std::find(mesh.positions.begin(), mesh.positions.end(), position);
    return mesh.normals.at(static_cast<std::size_t>(at - mesh.positions.begin()));
  };
  const auto one = decode_draco(*encode_draco(a, kUnit), kUnit);
  const auto two = decode_draco(*encode_draco(b, kUnit), kUnit);
  EXPECT_EQ(normal_at(*one, a.positions[5]), normal_at(*two, a.positions[5]));
}

TEST(DracoCodec, SurvivesVerticesAndEdgesThatAreNotManifold) {
  const ChunkMesh mesh = sample_pinched_tetrahedra();
  const auto decoded = decode_draco(*encode_draco(mesh, kUnit), kUnit);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(faces_of(*decoded), faces_of(mesh));
}

TEST(DracoCodec, WritesTheSameBytesForTheSameMesh) {
  const ChunkMesh mesh = sample_surface(32, 5);
  EXPECT_EQ(*encode_draco(mesh, kUnit), *encode_draco(mesh, kUnit));
}

TEST(DracoCodec, RefusesToEncodeNothing) {
  EXPECT_EQ(encode_draco({}, kUnit).error(), CodecError::kEmpty);
}

TEST(DracoCodec, RefusesALatticeThatIsNotTheOneEncodedFor) {
  const auto bytes = encode_draco(sample_surface(32, 5), kUnit);
  EXPECT_EQ(decode_draco(*bytes, mesh_lattice({1, 0, 0, 0}, 32, 1.0)).error(), CodecError::kMalformed);
  EXPECT_EQ(decode_draco(*bytes, mesh_lattice({0, 0, 0, 0}, 16, 1.0)).error(), CodecError::kMalformed);
}

TEST(DracoCodec, RefusesEveryStrictPrefix) {
  const auto bytes = *encode_draco(sample_surface(16, 5), mesh_lattice({0, 0, 0, 0}, 16, 1.0));
  std::size_t step = 1;
  for (std::size_t size = 0; size < bytes.size(); size += step) {
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode_draco(prefix, mesh_lattice({0, 0, 0, 0}, 16, 1.0))) << size;
    if (size > 256) step = 7;
  }
}

TEST(DracoCodec, SurvivesRandomMutations) {
  const MeshLattice lattice = mesh_lattice({0, 0, 0, 0}, 16, 1.0);
  const auto original = *encode_draco(sample_surface(16, 5), lattice);
  std::mt19937_64 random(20261122);
  std::size_t refused = 0;
  for (int round = 0; round < 1500; ++round) {
    std::vector<std::byte> bytes = original;
    const auto flips = 1 + random() % 6;
    for (std::uint64_t i = 0; i < flips; ++i) {
      const std::size_t window = random() % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
      bytes[random() % window] = static_cast<std::byte>(random());
    }
    const auto decoded = decode_draco(bytes, lattice);
    refused += decoded ? 0U : 1U;
    if (!decoded) continue;
    for (const glm::u16vec3& p : decoded->positions) {
      ASSERT_LE(std::max({p.x, p.y, p.z}), 16 * kStepsPerCell);
    }
    for (const std::uint32_t index : decoded->indices) ASSERT_LT(index, decoded->positions.size());
  }
  EXPECT_GT(refused, 500U);
}

TEST(DracoCodec, RefusesCountsThatNoChunkHas) {
  auto bytes = *encode_draco(sample_surface(32, 5), kUnit);
  // Behind the 9 bytes of header, 2 of flags and 1 of traversal: vertices and faces as varints of up to 5 bytes.
  const std::array<std::uint8_t, 10> huge{0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF, 0xFF, 0xFF, 0x03};
  for (std::size_t i = 0; i < huge.size(); ++i) bytes[12 + i] = static_cast<std::byte>(huge[i]);
  EXPECT_EQ(decode_draco(bytes, kUnit).error(), CodecError::kMalformed);
}

TEST(DracoCodec, RefusesMoreBytesThanAMessageHas) {
  EXPECT_EQ(decode_draco(std::vector<std::byte>(kOutboundMessageBytesMax + 1), kUnit).error(), CodecError::kTooLarge);
}

}  // namespace
}  // namespace talus::protocol
