#include "server/world/terrain_builder.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "protocol/mesh_codec.hpp"

namespace talus::server {

TerrainBuilder::TerrainBuilder(const Worlds& worlds, const Clock& clock, Metrics& metrics, std::size_t threads)
    : worlds_(worlds), clock_(clock), metrics_(metrics), scratch_(threads) {}

std::optional<ChunkPayload> TerrainBuilder::build(const PayloadName& name, std::size_t thread,
                                                  const CancelToken& token) {
  if (token.is_cancelled()) return std::nullopt;
  const WorldFunction& world = worlds_[name.world]->function();
  Scratch& scratch = scratch_[thread];

  const Instant start = clock_.now();
  const ChunkKind kind = build_chunk(world, name.key, scratch.build, scratch.mesh);
  const Instant built = clock_.now();
  metrics_.record(Hop::kBuildChunk, built - start);

  if (kind != ChunkKind::kMesh) return ChunkPayload{kind, {}};
  if (token.is_cancelled()) return std::nullopt;

  const protocol::MeshLattice lattice = protocol::mesh_lattice(name.key, world.cells(), world.voxel_m());
  auto bytes = name.format == PayloadFormat::kGlb
                   ? protocol::encode_glb(scratch.mesh, lattice,
                                          box_of(name.key, world.cells(), world.voxel_m()).low - name.origin)
                   : protocol::encode_draco(scratch.mesh, lattice);
  metrics_.record(Hop::kEncodeChunk, clock_.now() - built);
  if (!bytes) throw std::runtime_error("encode_chunk: " + std::string(protocol::describe(bytes.error())));
  // The payload stays for long: what the encoder reserved beyond it is given back.
  bytes->shrink_to_fit();
  return ChunkPayload{kind, std::move(*bytes)};
}

}  // namespace talus::server
