#include "protocol/meshopt_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <glm/geometric.hpp>

#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/lattice_vertex.hpp"
#include "protocol/limits.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::protocol {
namespace {

const MeshLattice kSmall = mesh_lattice({0, 0, 0, 0}, 16, 1.0);

TEST(MeshoptCodec, GivesBackEveryTriangleAtItsExactPlace) {
  for (const int cells : {1, 16, 32}) {
    const ChunkMesh mesh = sample_surface(cells, 7);
    const MeshLattice lattice = mesh_lattice({3, 0, 0, 0}, cells, 0.5);
    const auto decoded = decode_meshopt(*encode_meshopt(mesh, lattice), lattice);
    ASSERT_TRUE(decoded) << cells;
    EXPECT_EQ(faces_of(*decoded), faces_of(mesh)) << cells;
  }
}

TEST(MeshoptCodec, CarriesChunksAndStripsOfTheWorld) {
  const WorldFunction world{Manifest()};
  ChunkScratch scratch;
  ChunkMesh mesh;
  int strips = 0;
  ChunkKey key{4, 5, -2, 5};
  while (key.y < 5 && build_chunk(world, key, scratch, mesh) != ChunkKind::kMesh) ++key.y;
  ASSERT_LT(key.y, 5) << "some chunk of the stack holds the surface";
  const MeshLattice lattice = mesh_lattice(key, world.cells(), world.voxel_m());
  const auto chunk = decode_surface(*encode_meshopt(mesh, lattice), lattice);
  ASSERT_TRUE(chunk);
  EXPECT_EQ(faces_of(*chunk), faces_of(mesh));
  StripScratch strip_scratch;
  const ColumnLoader columns = [&](const ChunkKey& at, ColumnBlock& out) {
    world.columns(chunk_columns(world, at), out);
  };
  for (const ChunkFace face : {ChunkFace::kPx, ChunkFace::kNz}) {
    build_strip(world, key, face, columns, strip_scratch, mesh);
    if (mesh.indices.empty()) continue;
    ++strips;
    const MeshLattice finer = strip_lattice(key, world.cells(), world.voxel_m());
    const auto strip = decode_surface(*encode_meshopt(mesh, finer), finer);
    ASSERT_TRUE(strip);
    EXPECT_EQ(faces_of(*strip), faces_of(mesh));
  }
  EXPECT_GT(strips, 0);
  // The same by Draco: decode_surface knows it by its first bytes.
  const auto same = decode_surface(*encode_draco(*chunk, lattice), lattice);
  ASSERT_TRUE(same);
  EXPECT_EQ(faces_of(*same), faces_of(*chunk));
}

TEST(MeshoptCodec, KeepsNormalsWithinTwoDegreesWhereverTheyPoint) {
  std::mt19937 random(4);
  std::normal_distribution<float> any;
  for (int i = 0; i < 20'000; ++i) {
    const glm::vec3 normal = glm::normalize(glm::vec3(any(random), any(random), any(random)));
    const LatticeVertex vertex = pack_vertex({64, 70, 128}, normal, 0, 0);
    EXPECT_GT(glm::dot(normal_of(vertex), normal), std::cos(2.0F / 57.2958F)) << normal.x << ' ' << normal.y;
  }
  EXPECT_EQ(normal_of(pack_vertex({}, {0, 1, 0}, 0, 0)), glm::vec3(0, 1, 0));
}

TEST(MeshoptCodec, OrdersTrianglesForSmallVertexCaches) {
  // Vertices that a cache of 16, first in, first out, has to shade again: rows of 32 cells need one a triangle.
  const ChunkMesh mesh = *decode_meshopt(*encode_meshopt(sample_surface(32, 1), kUnit), kUnit);
  std::vector<std::uint32_t> cache;
  std::size_t shaded = 0;
  for (const std::uint32_t index : mesh.indices) {
    if (std::ranges::find(cache, index) != cache.end()) continue;
    ++shaded;
    cache.push_back(index);
    if (cache.size() > 16) cache.erase(cache.begin());
  }
  EXPECT_LT(static_cast<double>(shaded), 0.75 * static_cast<double>(mesh.triangles()));
}

TEST(MeshoptCodec, LeavesOutVerticesThatNoTriangleHas) {
  ChunkMesh mesh = sample_surface(4, 1);
  mesh.indices.resize(3);
  const MeshLattice lattice = mesh_lattice({0, 0, 0, 0}, 4, 1.0);
  const auto decoded = decode_meshopt(*encode_meshopt(mesh, lattice), lattice);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->positions.size(), 3U);
  EXPECT_EQ(faces_of(*decoded), faces_of(mesh));
}

TEST(MeshoptCodec, WritesTheVersionsOfItsStreamsThatTheSpecificationNames) {
  const auto bytes = *encode_meshopt(sample_surface(16, 5), kSmall);
  std::uint32_t index_bytes = 0;
  std::memcpy(&index_bytes, bytes.data() + 20, sizeof index_bytes);
  EXPECT_EQ(bytes[24], std::byte{0xE1}) << "indices by version 1";
  EXPECT_EQ(bytes[24 + index_bytes], std::byte{0xA0}) << "vertices by version 0";
}

TEST(MeshoptCodec, RefusesToEncodeNothing) {
  EXPECT_EQ(encode_meshopt({}, kUnit).error(), CodecError::kEmpty);
}

TEST(MeshoptCodec, RefusesALatticeThatIsNotTheOneEncodedFor) {
  const auto bytes = *encode_meshopt(sample_surface(32, 5), kUnit);
  EXPECT_EQ(decode_meshopt(bytes, mesh_lattice({1, 0, 0, 0}, 32, 1.0)).error(), CodecError::kMalformed);
  EXPECT_EQ(decode_meshopt(bytes, kSmall).error(), CodecError::kMalformed);
}

TEST(MeshoptCodec, RefusesEveryStrictPrefixAndWhatIsTooLong) {
  auto bytes = *encode_meshopt(sample_surface(16, 5), kSmall);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // Exactly as long as the prefix, so that a sanitizer sees one byte too many.
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(decode_meshopt(prefix, kSmall)) << size;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode_meshopt(bytes, kSmall));
  EXPECT_EQ(decode_meshopt(std::vector<std::byte>(kOutboundMessageBytesMax + 1), kSmall).error(),
            CodecError::kTooLarge);
}

TEST(MeshoptCodec, RefusesCountsAndPlacesThatNoChunkHas) {
  const auto original = *encode_meshopt(sample_surface(16, 5), kSmall);
  for (const std::size_t at : {12U, 16U, 20U}) {
    for (const unsigned value : {0x00U, 0xFFU}) {
      auto bytes = original;
      for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value);
      EXPECT_EQ(decode_meshopt(bytes, kSmall).error(), CodecError::kMalformed) << at << ' ' << value;
    }
  }
  LatticeVertex vertex = pack_vertex({1024, 1024, 1000}, {0, 1, 0}, 0, 0);
  EXPECT_EQ(position_of(vertex, 16), glm::u16vec3(1024, 1024, 1000));
  EXPECT_FALSE(position_of(vertex, 15));
  vertex.edge = 0xC0;
  EXPECT_FALSE(position_of(vertex, 16)) << "along no axis";
}

TEST(MeshoptCodec, SurvivesRandomMutations) {
  const auto original = *encode_meshopt(sample_surface(16, 5), kSmall);
  std::mt19937_64 random(20261124);
  std::size_t refused = 0;
  for (int round = 0; round < 1500; ++round) {
    std::vector<std::byte> bytes = original;
    const auto flips = 1 + random() % 6;
    for (std::uint64_t i = 0; i < flips; ++i) {
      const std::size_t window = random() % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
      bytes[random() % window] = static_cast<std::byte>(random());
    }
    const auto decoded = decode_meshopt(bytes, kSmall);
    refused += decoded ? 0U : 1U;
    if (!decoded) continue;
    for (const glm::u16vec3& p : decoded->positions) ASSERT_LE(std::max({p.x, p.y, p.z}), 16 * kStepsPerCell);
    for (const std::uint32_t index : decoded->indices) ASSERT_LT(index, decoded->positions.size());
  }
  EXPECT_GT(refused, 300U);
}

}  // namespace
}  // namespace talus::protocol
