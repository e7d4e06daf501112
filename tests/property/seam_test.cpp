// Chunks of one LOD fit: what a client decodes from the wire on a shared face is the same from both sides, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <vector>

#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"
#include "tests/support/random.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSeamSeed = 8;
constexpr int kKeysPerLod = 160;

/// What a chunk looks like to a client: built, encoded, decoded.
class WireBytes {
 public:
  explicit WireBytes(const WorldFunction& world) : world_(world) {}

  std::optional<ChunkMesh> operator()(const ChunkKey& key) {
    ChunkMesh mesh;
    if (build_chunk(world_, key, scratch_, mesh) != ChunkKind::kMesh) return std::nullopt;
    const auto lattice = protocol::mesh_lattice(key, world_.cells(), world_.voxel_m());
    const auto bytes = protocol::encode_draco(mesh, lattice);
    if (!bytes) return std::nullopt;
    auto decoded = protocol::decode_draco(*bytes, lattice);
    EXPECT_TRUE(decoded.has_value());
    return decoded ? std::optional(std::move(*decoded)) : std::nullopt;
  }

 private:
  const WorldFunction& world_;
  ChunkScratch scratch_;
};

/// A vertex on a face: its two coordinates in the face, and the bits of everything that travels with it.
using FaceVertex = std::array<std::uint32_t, 7>;

std::vector<FaceVertex> on_face(const ChunkMesh& mesh, int axis, int at) {
  std::vector<FaceVertex> out;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::u16vec3& p = mesh.positions[v];
    if (p[axis] != at) continue;
    const glm::vec3& n = mesh.normals[v];
    out.push_back({p[(axis + 1) % 3], p[(axis + 2) % 3], std::bit_cast<std::uint32_t>(n.x),
                   std::bit_cast<std::uint32_t>(n.y), std::bit_cast<std::uint32_t>(n.z), mesh.materials[v],
                   mesh.ridges[v]});
  }
  std::ranges::sort(out);
  // The encoder may split a vertex that several fans share: the copies are equal and count once.
  out.erase(std::ranges::unique(out).begin(), out.end());
  return out;
}

TEST(Seams, OfOneLodAreBitEqualAfterDecoding) {
  const WorldFunction world{Manifest()};
  WireBytes wire(world);
  test::Random random(kSeamSeed);
  int faces = 0;
  std::size_t vertices = 0;
  for (int lod = 0; lod <= kLodMax; ++lod) {
    for (int n = 0; n < kKeysPerLod; ++n) {
      const ChunkKey key = test::random_surface_key(world, random, lod);
      const int axis = static_cast<int>(random.whole(0, 2));
      ChunkKey next = key;
      (axis == 0 ? next.x : axis == 1 ? next.y : next.z) += 1;
      const auto here = wire(key);
      const auto there = wire(next);
      const auto from_here = here ? on_face(*here, axis, world.cells() * kStepsPerCell) : std::vector<FaceVertex>();
      const auto from_there = there ? on_face(*there, axis, 0) : std::vector<FaceVertex>();
      ASSERT_EQ(from_here, from_there) << "lod " << key.lod << " at " << key.x << ' ' << key.y << ' ' << key.z
                                       << ", axis " << axis << ", seed " << kSeamSeed;
      faces += from_here.empty() ? 0 : 1;
      vertices += from_here.size();
    }
  }
  std::printf("%d shared faces with surface, %zu vertices on them\n", faces, vertices);
  EXPECT_GT(faces, kKeysPerLod * 7) << "too few faces had a surface to compare";
}

}  // namespace
}  // namespace talus
