#include "client_sample/load/samples.hpp"

#include <algorithm>

#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::load {

void Samples::offer(const ChunkKey& key, ChunkKind kind, std::span<const std::byte> payload) {
  ++offered_;
  std::size_t at = kept_.size();
  if (at >= size_) {
    at = static_cast<std::size_t>(random_() % offered_);
    if (at >= size_) return;
  } else {
    kept_.emplace_back();
  }
  kept_[at] = {key, kind, {payload.begin(), payload.end()}};
}

std::vector<std::string> Samples::compare(const Manifest& manifest) const {
  std::vector<std::string> out;
  const WorldFunction world(manifest);
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (const Kept& kept : kept_) {
    const ChunkKind kind = build_chunk(world, kept.key, scratch, mesh);
    std::vector<std::byte> payload;
    if (kind == ChunkKind::kMesh) {
      payload = protocol::encode_draco(mesh, protocol::mesh_lattice(kept.key, world.cells(), world.voxel_m()))
                    .value_or(std::vector<std::byte>{});
    }
    if (kind == kept.kind && payload == kept.payload) continue;
    out.push_back("chunk " + std::to_string(kept.key.lod) + '/' + std::to_string(kept.key.x) + '/' +
                  std::to_string(kept.key.y) + '/' + std::to_string(kept.key.z) +
                  " is not what the world function gives here: " + std::to_string(kept.payload.size()) +
                  " bytes came, " + std::to_string(payload.size()) + " were expected");
  }
  return out;
}

}  // namespace talus::load
