#include "server/world/terrain_builder.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "core/map/map_tile.hpp"
#include "protocol/mesh_codec.hpp"
#include "protocol/png.hpp"

namespace talus::server {

namespace {

/// 256 * 48 KiB = 12 MiB: what all sessions have in the making at once stands on these, and then some.
constexpr std::size_t kColumnBlocks = 256;

}  // namespace

TerrainBuilder::TerrainBuilder(const Worlds& worlds, const Clock& clock, Metrics& metrics, std::size_t threads)
    : worlds_(worlds), clock_(clock), metrics_(metrics), scratch_(threads), columns_(kColumnBlocks) {}

/// What core's build_chunk does, with heights remembered for long and columns for a while.
ChunkKind TerrainBuilder::build_mesh(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  scratch.mesh.clear();
  const glm::dvec2 range = world.height_range_m();
  if (const ChunkKind kind = kind_by_heights(world, name.key, range.x, range.y); kind != ChunkKind::kMesh) return kind;
  const Footprint footprint{name.world, name.key.lod, name.key.x, name.key.z};
  if (const auto known = footprints_.load(footprint)) {
    const ChunkKind kind =
        kind_by_heights(world, name.key, static_cast<double>(known->low_m), static_cast<double>(known->high_m));
    if (kind != ChunkKind::kMesh) return kind;
  }
  const ColumnName columns{name.world, name.key.lod, name.key.x, name.key.z};
  if (!columns_.load(columns, scratch.build.columns)) {
    world.columns(chunk_columns(world, name.key), scratch.build.columns);
    columns_.store(columns, scratch.build.columns);
    footprints_.store(footprint, {scratch.build.columns.height_low_m, scratch.build.columns.height_high_m});
  }
  const auto low_m = static_cast<double>(scratch.build.columns.height_low_m);
  const auto high_m = static_cast<double>(scratch.build.columns.height_high_m);
  if (const ChunkKind kind = kind_by_heights(world, name.key, low_m, high_m); kind != ChunkKind::kMesh) return kind;
  return mesh_chunk(world, name.key, sample_chunk(world, name.key, scratch.build), scratch.build, scratch.mesh);
}

ChunkPayload TerrainBuilder::build_map(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  const MapView view = map_view({name.key.lod, name.key.x, name.key.z});
  scratch.rgb.resize(std::size_t{3} * kMapTilePixels * kMapTilePixels);
  const Instant start = clock_.now();
  draw_map(world, view, {}, scratch.map, scratch.rgb);
  const Instant drawn = clock_.now();
  metrics_.record(Hop::kDrawMap, drawn - start);
  ChunkPayload out{ChunkKind::kMesh, protocol::encode_png(view.width, view.height, scratch.rgb)};
  metrics_.record(Hop::kEncodeMap, clock_.now() - drawn);
  out.bytes.shrink_to_fit();
  return out;
}

std::optional<ChunkPayload> TerrainBuilder::build(const PayloadName& name, std::size_t thread,
                                                  const CancelToken& token) {
  if (token.is_cancelled()) return std::nullopt;
  const WorldFunction& world = worlds_[name.world]->function();
  Scratch& scratch = scratch_[thread];
  if (name.format == PayloadFormat::kMap) return build_map(name, world, scratch);

  const Instant start = clock_.now();
  const ChunkKind kind = build_mesh(name, world, scratch);
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
