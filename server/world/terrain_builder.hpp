// The builder of the real server: evaluates the world, extracts, encodes.
#pragma once

#include <expected>
#include <vector>

#include "core/map/draw_map.hpp"
#include "core/mesh/build_chunk.hpp"
#include "core/mesh/density_tile.hpp"
#include "core/mesh/height_tile.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/codec_error.hpp"
#include "server/cache/column_memo.hpp"
#include "server/observe/metrics.hpp"
#include "server/schedule/clock.hpp"
#include "server/world/chunk_builder.hpp"
#include "server/world/cost_model.hpp"
#include "server/world/footprint_memo.hpp"
#include "server/world/tile_memo.hpp"
#include "server/world/world.hpp"

namespace talus::server {

class TerrainBuilder final : public ChunkBuilder {
 public:
  /// All must outlive the builder. `threads` is the size of the pool.
  TerrainBuilder(const Worlds& worlds, const Clock& clock, Metrics& metrics, std::size_t threads);

  std::optional<RuledOut> ruled_out(const PayloadName& name) const override;
  double predicted_s(const PayloadName& name) const override;
  std::optional<ChunkPayload> build(const PayloadName& name, std::size_t thread, const CancelToken& token) override;

 private:
  struct PlacedMesh {
    ChunkKey key;
    ChunkMesh mesh;
  };
  /// Part of a tile: chunks one above the other and the strips on their sides as one mesh, since engines pay by the
  /// mesh: CesiumJS decodes one a frame where there are two processors.
  struct TileStack {
    ChunkKey lowest;
    std::int32_t chunks = 0;  ///< that it is high
    ChunkMesh mesh;
  };

  /// Working memory of one pool thread: after its first surface chunk only the payload itself is allocated.
  struct alignas(64) Scratch {
    ChunkScratch build;
    StripScratch strip;
    ChunkMesh mesh;
    HeightTile height;
    DensityTile density;
    std::vector<PlacedMesh> chunks;  ///< of a tile's column, from below
    std::vector<TileStack> tile;     ///< from below
    MapScratch map;
    std::vector<std::uint8_t> rgb;  ///< of the tile being drawn
  };

  ChunkPayload build_map(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  using Bytes = std::expected<std::vector<std::byte>, protocol::CodecError>;

  /// Columns under a chunk, remembered or evaluated.
  void load_columns(std::uint32_t world, const ChunkKey& key, VolumeScratch& volume, ColumnBlock& out);
  /// Air, rock, or kMesh with the chunk's columns in `scratch`.
  ChunkKind load_if_crossed(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  ChunkKind sample_strip(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  ChunkKind sample(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  /// All of a column's chunks and the strips on its sides into `scratch`.
  void sample_tile(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  void stack_tile(const PayloadName& name, const WorldFunction& world, Scratch& scratch);
  Bytes encode_tile(const PayloadName& name, const WorldFunction& world, const Scratch& scratch) const;
  Bytes encode(const PayloadName& name, const WorldFunction& world, const Scratch& scratch) const;
  CostClass cost_class(const PayloadName& name) const;

  const Worlds& worlds_;
  const Clock& clock_;
  Metrics& metrics_;
  TileMemo tiles_;
  std::vector<Scratch> scratch_;
  FootprintMemo footprints_;
  ColumnMemo columns_;
  CostModel costs_;
};

}  // namespace talus::server
