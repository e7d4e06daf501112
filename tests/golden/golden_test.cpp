// Chunks as they were when kGeneratorVersion was last raised. A difference here means worlds have changed: raise the
// version and rewrite the file with `TALUS_GOLDEN=write build/release/bin/golden_test`.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "core/base/hash.hpp"
#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus {
namespace {

constexpr const char* kFile = TALUS_SOURCE_DIR "/tests/golden/chunks.txt";

std::vector<ChunkKey> golden_keys() {
  return {{0, 0, 40, 0},
          {0, 3, 41, -4},
          {0, 31'250'000, 24, -31'250'000},
          {0, 130, 5, 77},
          {1, -7, 14, 12},
          {1, -3'000, -3, 20'000},
          {2, 40, 3, 40},
          {3, -31, 0, 17},
          {4, 5, 0, 5},
          {5, -2, 0, 3},
          {6, 1, 0, -1},
          {7, 0, 0, 0},
          {8, -1, 0, -1},
          {9, 0, 0, 1},
          {10, 3, 0, 3},
          {11, -244'140, 0, 2},
          {12, 0, 0, 0},
          {0, 0, 5'000, 0},
          {0, 0, -5'000, 0},
          {12, kChunkLimit, 0, -kChunkLimit}};
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

/// One line per chunk: key, kind, counts, hash of the mesh, hash of its Draco bytes.
std::string describe_chunks() {
  const WorldFunction world{Manifest()};
  std::ostringstream out;
  out << "generator " << kGeneratorVersion << "\n";
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (const ChunkKey& key : golden_keys()) {
    const ChunkKind kind = build_chunk(world, key, scratch, mesh);
    std::uint64_t hash = hash_of(mesh.positions, 1);
    hash = hash_of(mesh.normals, hash);
    hash = hash_of(mesh.materials, hash);
    hash = hash_of(mesh.ridges, hash);
    hash = hash_of(mesh.indices, hash);
    const auto bytes = protocol::encode_draco(mesh, protocol::mesh_lattice(key, world.cells(), world.voxel_m()));
    out << std::dec << key.lod << ' ' << key.x << ' ' << key.y << ' ' << key.z << ' ' << static_cast<int>(kind) << ' '
        << mesh.positions.size() << ' ' << mesh.triangles() << ' ' << std::hex << hash << ' '
        << (bytes ? hash_of(*bytes, 1) : 0) << "\n";
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
  EXPECT_EQ(now, was.str()) << "worlds have changed: raise kGeneratorVersion and rewrite " << kFile;
}

}  // namespace
}  // namespace talus
