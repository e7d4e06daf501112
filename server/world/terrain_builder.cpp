#include "server/world/terrain_builder.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/map/map_tile.hpp"
#include "protocol/mesh_codec.hpp"
#include "protocol/meshopt_codec.hpp"
#include "protocol/png.hpp"
#include "protocol/tile_codec.hpp"

namespace talus::server {

namespace {

/// 256 * 64 KiB = 16 MiB: what all sessions have in the making at once stands on these, and then some.
constexpr std::size_t kColumnBlocks = 256;

/// Whether the key is a chunk's, so that its heights can rule it out.
bool is_of_chunk(PayloadFormat format) {
  return is_chunk_mesh(format) || format == PayloadFormat::kGlb || format == PayloadFormat::kDensity;
}

Footprint footprint_of(const PayloadName& name) {
  return {name.world, name.key.lod, name.key.x, name.key.z};
}

/// The same positions counted in steps of a lattice `scale` times as fine; at most 16 bits of them.
void refine_positions(int scale, ChunkMesh& mesh) {
  for (glm::u16vec3& position : mesh.positions) position *= static_cast<std::uint16_t>(scale);
}

/// The lattice of a tile is that of its strips; at LOD 0, where there are none, that of its chunks.
protocol::MeshLattice tile_lattice(const ChunkKey& key, const WorldFunction& world) {
  return key.lod > 0 ? protocol::strip_lattice(key, world.cells(), world.voxel_m())
                     : protocol::mesh_lattice(key, world.cells(), world.voxel_m());
}

}  // namespace

TerrainBuilder::TerrainBuilder(const Worlds& worlds, const Clock& clock, Metrics& metrics, std::size_t threads)
    : worlds_(worlds), clock_(clock), metrics_(metrics), tiles_(metrics), scratch_(threads), columns_(kColumnBlocks) {
  for (Scratch& scratch : scratch_) scratch.build.volume.relief.others = &tiles_;
}

std::optional<RuledOut> TerrainBuilder::ruled_out(const PayloadName& name) const {
  if (!is_of_chunk(name.format)) return std::nullopt;
  const WorldFunction& world = worlds_[name.world]->function();
  const glm::dvec2 range = world.height_range_m();
  if (const ChunkKind kind = kind_by_heights(world, name.key, range.x, range.y); kind != ChunkKind::kMesh) {
    return RuledOut{kind, false};
  }
  const auto known = footprints_.load(footprint_of(name));
  metrics_.add(known ? Count::kHeightsRemembered : Count::kHeightsUnknown);
  if (!known) return std::nullopt;
  const ChunkKind kind =
      kind_by_heights(world, name.key, static_cast<double>(known->low_m), static_cast<double>(known->high_m));
  if (kind != ChunkKind::kMesh) return RuledOut{kind, true};
  return std::nullopt;
}

CostClass TerrainBuilder::cost_class(const PayloadName& name) const {
  if (name.format == PayloadFormat::kMap) return CostClass::kMapTile;
  return footprints_.load(footprint_of(name)) ? CostClass::kKnownGround : CostClass::kFreshGround;
}

double TerrainBuilder::predicted_s(const PayloadName& name) const {
  return costs_.predicted_s(cost_class(name));
}

void TerrainBuilder::load_columns(std::uint32_t world, const ChunkKey& key, VolumeScratch& volume, ColumnBlock& out) {
  const ColumnName name{world, key.lod, key.x, key.z};
  const bool is_remembered = columns_.load(name, out);
  metrics_.add(is_remembered ? Count::kColumnsRemembered : Count::kColumnsEvaluated);
  if (is_remembered) return;
  const WorldFunction& function = worlds_[world]->function();
  function.columns(chunk_columns(function, key), out);
  function.volume(out, volume);
  columns_.store(name, out);
  footprints_.store({world, key.lod, key.x, key.z}, {out.rock_below_m, out.air_above_m});
}

/// What core's build_chunk does, with heights remembered for long and columns for a while.
ChunkKind TerrainBuilder::load_if_crossed(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  if (const auto known = ruled_out(name)) return known->kind;
  load_columns(name.world, name.key, scratch.build.volume, scratch.build.columns);
  const ColumnBlock& columns = scratch.build.columns;
  return kind_by_heights(world, name.key, static_cast<double>(columns.rock_below_m),
                         static_cast<double>(columns.air_above_m));
}

/// A chunk of the finest LOD has no finer neighbour, and its strips are empty.
ChunkKind TerrainBuilder::sample_strip(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  scratch.mesh.clear();
  if (name.key.lod == 0) return ChunkKind::kAir;
  const ColumnLoader columns = [&](const ChunkKey& key, ColumnBlock& out) {
    load_columns(name.world, key, scratch.build.volume, out);
  };
  build_strip(world, name.key, name.face, columns, scratch.strip, scratch.mesh);
  return scratch.mesh.indices.empty() ? ChunkKind::kAir : ChunkKind::kMesh;
}

ChunkKind TerrainBuilder::sample(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  if (name.format == PayloadFormat::kHeight) {
    load_columns(name.world, name.key, scratch.build.volume, scratch.build.columns);
    sample_height_tile(world, scratch.build.columns, scratch.height);
    return ChunkKind::kMesh;
  }
  if (is_strip(name.format)) return sample_strip(name, world, scratch);
  if (name.format == PayloadFormat::kTile) {
    sample_tile(name, world, scratch);
    return ChunkKind::kMesh;
  }
  if (const ChunkKind kind = load_if_crossed(name, world, scratch); kind != ChunkKind::kMesh) return kind;
  if (name.format == PayloadFormat::kDensity) {
    return sample_density_tile(world, name.key, scratch.build, scratch.density);
  }
  return mesh_chunk(world, name.key, sample_chunk(world, name.key, scratch.build), scratch.build, scratch.mesh);
}

void TerrainBuilder::sample_tile(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  scratch.chunks.clear();
  scratch.tile.clear();
  const glm::dvec2 range = world.height_range_m();
  const double edge_m = protocol::edge_of(worlds_[name.world]->shape(), name.key.lod);
  const auto first = static_cast<std::int32_t>(std::floor(range.x / edge_m));
  const auto last = static_cast<std::int32_t>(std::floor(range.y / edge_m));
  PayloadName chunk = name;
  chunk.format = PayloadFormat::kDraco;
  for (chunk.key.y = first; chunk.key.y <= last; ++chunk.key.y) {
    if (sample(chunk, world, scratch) == ChunkKind::kMesh) scratch.chunks.push_back({chunk.key, scratch.mesh});
  }
  if (!scratch.chunks.empty()) stack_tile(name, world, scratch);
}

/// Puts the column's chunks into stacks as high as 16 bits of the lattice reach, with the strips on their sides. A
/// finer surface may cross a side one chunk above or below where the column's own does.
void TerrainBuilder::stack_tile(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  const int steps = tile_lattice(name.key, world).cells * kStepsPerCell;
  const int scale = steps / (world.cells() * kStepsPerCell);
  const bool has_strips = name.key.lod > 0;
  const std::int32_t chunks_max = 0xFFFF / steps;
  const auto place = [&](const ChunkKey& key, const ChunkMesh& mesh) {
    if (mesh.indices.empty()) return;
    if (scratch.tile.empty() || key.y - scratch.tile.back().lowest.y >= chunks_max) {
      scratch.tile.push_back({key, 0, {}});
    }
    TileStack& stack = scratch.tile.back();
    const std::int32_t below = key.y - stack.lowest.y;
    stack.chunks = std::max(stack.chunks, below + 1);
    append_above(mesh, below * steps, stack.mesh);
  };
  auto chunk = scratch.chunks.begin();
  PayloadName strip = name;
  strip.key.y = scratch.chunks.front().key.y - (has_strips ? 1 : 0);
  const std::int32_t last = scratch.chunks.back().key.y + (has_strips ? 1 : 0);
  for (; strip.key.y <= last; ++strip.key.y) {
    if (chunk != scratch.chunks.end() && chunk->key.y == strip.key.y) {
      refine_positions(scale, chunk->mesh);
      place(chunk->key, chunk->mesh);
      ++chunk;
    }
    if (!has_strips) continue;
    for (const ChunkFace face : {ChunkFace::kPx, ChunkFace::kNx, ChunkFace::kPz, ChunkFace::kNz}) {
      strip.face = face;
      sample_strip(strip, world, scratch);
      place(strip.key, scratch.mesh);
    }
  }
}

TerrainBuilder::Bytes TerrainBuilder::encode_tile(const PayloadName& name, const WorldFunction& world,
                                                  const Scratch& scratch) const {
  std::vector<protocol::GlbPart> parts;
  for (const TileStack& stack : scratch.tile) {
    protocol::MeshLattice lattice = tile_lattice(stack.lowest, world);
    lattice.cells *= stack.chunks;
    parts.push_back({stack.mesh, lattice, box_of(stack.lowest, world.cells(), world.voxel_m()).low - name.origin});
  }
  return protocol::encode_glb(parts, name.key);
}

TerrainBuilder::Bytes TerrainBuilder::encode(const PayloadName& name, const WorldFunction& world,
                                             const Scratch& scratch) const {
  const protocol::MeshLattice lattice = protocol::mesh_lattice(name.key, world.cells(), world.voxel_m());
  switch (name.format) {
    case PayloadFormat::kDraco:
      return protocol::encode_draco(scratch.mesh, lattice);
    case PayloadFormat::kGlb:
      return protocol::encode_chunk_glb(scratch.mesh, name.key, world.cells(), world.voxel_m(), name.origin);
    case PayloadFormat::kDensity:
      return protocol::encode_density(scratch.density, name.key);
    case PayloadFormat::kHeight:
      return protocol::encode_height(scratch.height, name.key);
    case PayloadFormat::kStrip:
      return protocol::encode_draco(scratch.mesh, protocol::strip_lattice(name.key, world.cells(), world.voxel_m()));
    case PayloadFormat::kMeshopt:
      return protocol::encode_meshopt(scratch.mesh, lattice);
    case PayloadFormat::kMeshoptStrip:
      return protocol::encode_meshopt(scratch.mesh, protocol::strip_lattice(name.key, world.cells(), world.voxel_m()));
    case PayloadFormat::kTile:
      return encode_tile(name, world, scratch);
    case PayloadFormat::kMap:
      break;
  }
  return std::unexpected(protocol::CodecError::kInternal);
}

ChunkPayload TerrainBuilder::build_map(const PayloadName& name, const WorldFunction& world, Scratch& scratch) {
  const MapView view = map_view({name.key.lod, name.key.x, name.key.z});
  scratch.rgb.resize(std::size_t{3} * kMapTilePixels * kMapTilePixels);
  const Instant start = clock_.now();
  draw_map(world, view, {name.layer, 0}, scratch.map, scratch.rgb);
  const Instant drawn = clock_.now();
  metrics_.record(Hop::kDrawMap, drawn - start);
  ChunkPayload out{ChunkKind::kMesh, protocol::encode_png(view.width, view.height, scratch.rgb)};
  const Instant encoded = clock_.now();
  metrics_.record(Hop::kEncodeMap, encoded - drawn);
  costs_.learn(CostClass::kMapTile, std::chrono::duration<double>(encoded - start).count());
  out.bytes.shrink_to_fit();
  return out;
}

std::optional<ChunkPayload> TerrainBuilder::build(const PayloadName& name, std::size_t thread,
                                                  const CancelToken& token) {
  if (token.is_cancelled()) return std::nullopt;
  const WorldFunction& world = worlds_[name.world]->function();
  Scratch& scratch = scratch_[thread];
  if (name.format == PayloadFormat::kMap) return build_map(name, world, scratch);

  const CostClass cost = cost_class(name);
  const Instant start = clock_.now();
  const ChunkKind kind = sample(name, world, scratch);
  const Instant built = clock_.now();
  metrics_.record(Hop::kBuildChunk, built - start);

  if (kind != ChunkKind::kMesh) {
    costs_.learn(cost, std::chrono::duration<double>(built - start).count());
    return ChunkPayload{kind, {}, 0};
  }
  if (token.is_cancelled()) return std::nullopt;

  Bytes bytes = encode(name, world, scratch);
  const Instant encoded = clock_.now();
  metrics_.record(Hop::kEncodeChunk, encoded - built);
  costs_.learn(cost, std::chrono::duration<double>(encoded - start).count());
  if (!bytes) throw std::runtime_error("encode_chunk: " + std::string(protocol::describe(bytes.error())));
  // The payload stays for long: what the encoder reserved beyond it is given back.
  bytes->shrink_to_fit();
  const unsigned faces = is_chunk_mesh(name.format) ? faces_reached(scratch.mesh, world.cells()) : 0;
  return ChunkPayload{kind, std::move(*bytes), static_cast<std::uint8_t>(faces)};
}

}  // namespace talus::server
