// Chunks and strips as they were when kGeneratorVersion was last raised. A difference here means worlds have changed:
// raise the version. Where only hashes of payloads differ, a format has: raise its edition (server/world/world.cpp).
// Then rewrite the file with `TALUS_GOLDEN=write build/release/bin/golden_test`.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <expected>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "core/base/hash.hpp"
#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/mesh_codec.hpp"
#include "protocol/meshopt_codec.hpp"

namespace talus {
namespace {

constexpr const char* kFile = TALUS_SOURCE_DIR "/tests/golden/chunks.txt";

/// The chunk of `lod` that holds the ground at the middle of the column (x, z) of its size.
ChunkKey ground_at(const WorldFunction& world, int lod, std::int32_t x, std::int32_t z) {
  const std::int64_t edge = static_cast<std::int64_t>(world.cells()) << lod;
  ColumnBlock block;
  world.columns({x * edge + edge / 2, z * edge + edge / 2, 1, 1, 1, world.voxel_m()}, block);
  const double chunks = static_cast<double>(block.height_m[0]) / (static_cast<double>(edge) * world.voxel_m());
  return {lod, x, static_cast<std::int32_t>(std::floor(chunks)), z};
}

std::vector<ChunkKey> golden_keys(const WorldFunction& world) {
  std::vector<ChunkKey> keys{{0, 0, 5'000, 0}, {0, 0, -5'000, 0}, {12, kChunkLimit, 0, -kChunkLimit}};
  struct Place {
    int lod;
    std::int32_t x, z;
  };
  for (const auto& [lod, x, z] : {Place{0, 0, 0},
                                  {0, 3, -4},
                                  {0, 31'250'000, -31'250'000},
                                  {0, 130, 77},
                                  {1, -7, 12},
                                  {1, -3'000, 20'000},
                                  {2, 40, 40},
                                  {3, -31, 17},
                                  {4, 5, 5},
                                  {5, -2, 3},
                                  {6, 1, -1},
                                  {7, 0, 0},
                                  {8, -1, -1},
                                  {9, 0, 1},
                                  {10, 3, 3},
                                  {11, -244'140, 2},
                                  {12, 0, 0}}) {
    keys.push_back(ground_at(world, lod, x, z));
  }
  // A headland with arches: what is carved below its ground.
  for (std::int32_t y = 0; y < 3; ++y) keys.push_back({0, 150, y, 1228});
  keys.push_back({1, 75, 0, 614});
  return keys;
}

std::uint64_t hash_of(const void* data, std::size_t bytes, std::uint64_t hash) {
  const auto* at = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i) hash = mix64(hash, at[i]);
  return hash;
}

template <class T>
std::uint64_t hash_of(const std::vector<T>& values, std::uint64_t hash) {
  return hash_of(values.data(), values.size() * sizeof(T), hash);
}

std::uint64_t hash_of(const ChunkMesh& mesh) {
  std::uint64_t hash = hash_of(mesh.positions, 1);
  hash = hash_of(mesh.normals, hash);
  hash = hash_of(mesh.materials, hash);
  hash = hash_of(mesh.ridges, hash);
  return hash_of(mesh.indices, hash);
}

using Payload = std::expected<std::vector<std::byte>, protocol::CodecError>;

/// 0 for what has no payload: no triangle.
std::uint64_t hash_of(const Payload& payload) {
  return payload ? hash_of(*payload, 1) : 0;
}

/// Counts, and hashes of the mesh and of its payloads.
void describe(const ChunkMesh& mesh, const protocol::MeshLattice& lattice, std::ostream& out) {
  out << std::dec << mesh.positions.size() << ' ' << mesh.triangles() << ' ' << std::hex << hash_of(mesh) << " drc "
      << hash_of(protocol::encode_draco(mesh, lattice)) << " mesh " << hash_of(protocol::encode_meshopt(mesh, lattice))
      << std::dec;
}

/// One line per chunk: key, kind, what describe() says, hash of its glTF. Below it one for each of its strips.
std::string describe_chunks() {
  const WorldFunction world{Manifest()};
  const int cells = world.cells();
  const double voxel_m = world.voxel_m();
  std::ostringstream out;
  out << "generator " << kGeneratorVersion << "\n";
  ChunkScratch scratch;
  StripScratch strip_scratch;
  ChunkMesh mesh;
  const ColumnLoader columns = [&](const ChunkKey& key, ColumnBlock& block) {
    world.columns(chunk_columns(world, key), block);
  };
  for (const ChunkKey& key : golden_keys(world)) {
    const ChunkKind kind = build_chunk(world, key, scratch, mesh);
    out << key.lod << ' ' << key.x << ' ' << key.y << ' ' << key.z << ' ' << static_cast<int>(kind) << ' ';
    describe(mesh, protocol::mesh_lattice(key, cells, voxel_m), out);
    out << " glb " << std::hex << hash_of(protocol::encode_chunk_glb(mesh, key, cells, voxel_m, {})) << std::dec
        << "\n";
    if (key.lod == 0 || kind != ChunkKind::kMesh) continue;
    for (const ChunkFace face : kAllChunkFaces) {
      build_strip(world, key, face, columns, strip_scratch, mesh);
      if (mesh.indices.empty()) continue;
      out << "  strip " << static_cast<int>(face) << ' ';
      describe(mesh, protocol::strip_lattice(key, cells, voxel_m), out);
      out << "\n";
    }
  }
  return out.str();
}

TEST(Golden, ChunksAreWhatTheyWere) {
  const std::string now = describe_chunks();
  const char* mode = std::getenv("TALUS_GOLDEN");
  if (mode != nullptr && std::string_view(mode) == "write") {
    std::ofstream(kFile) << now;
    GTEST_SKIP() << "wrote " << kFile;
  }
  std::ostringstream was;
  was << std::ifstream(kFile).rdbuf();
  EXPECT_EQ(now, was.str())
      << "worlds have changed, or only payloads: raise kGeneratorVersion, or their edition, and rewrite " << kFile;
}

}  // namespace
}  // namespace talus
