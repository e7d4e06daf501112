// The world as OGC 3D Tiles 1.1: quadtrees of columns, described and never stored. SPEC.md, "3D Tiles".
//
// Based on: Open Geospatial Consortium, 3D Tiles Specification 1.1, 2023, sections on implicit tiling and its subtree
// binary. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/grid/chunk_key.hpp"
#include "protocol/interest_area.hpp"

namespace talus::protocol {

/// Levels of tiles that one subtree describes: 341 tiles, which engines make in one go.
inline constexpr int kSubtreeLevels = 5;
/// The whole world's tree: 30 levels are what engines count without overflow, and reach 2^28 chunks of LOD 0 from the
/// origin on every side.
inline constexpr int kWorldTreeLevels = 30;
inline constexpr double kTilesetKmMax = 64.0;

/// A square of columns as a quadtree: level 0 is its root, the last level is LOD 0. A tile holds all chunks of one
/// column.
struct TileTree {
  int levels = 1;
  std::int64_t x = 0;  ///< of its lowest corner, in chunks of LOD 0
  std::int64_t z = 0;
};
TileTree world_tree();
/// The tree below one column of chunks.
TileTree column_tree(int lod, std::int32_t x, std::int32_t z);

/// A tile of a tree, as its URL names it. 3D Tiles count y where the world counts -z.
struct TileId {
  int level = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};
/// The column whose chunks a tile holds, y = 0. Nothing for a tile that the tree has not, or that is coarser than any
/// chunk.
std::optional<ChunkKey> column_of(const TileTree& tree, const TileId& tile);
/// Whether a subtree begins at `tile`.
bool has_subtree(const TileTree& tree, const TileId& tile);

/// The subtree binary that begins at any tile of `level`: they are all alike, since every column has a surface.
std::vector<std::byte> encode_subtree(const TileTree& tree, int level);

/// Where a tileset stands, and how much of the world it is.
struct TilesetPlace {
  std::optional<glm::dvec2> origin_m;  ///< x, z of the local frame's zero; absent: the whole world around its own
  double km = 8.0;                     ///< with an origin: half the side of the square that is surely covered
  std::optional<glm::dvec2> latitude_longitude_deg;  ///< where the frame's zero touches the WGS 84 ellipsoid
};
/// A square of columns of one LOD.
struct ColumnSquare {
  int lod = 0;
  std::int32_t x = 0;  ///< of its lowest corner
  std::int32_t z = 0;
  int side = 0;  ///< columns; at most 12
};
/// The columns whose heights a local tileset wants to know, so that its boxes end where the ground does: its implicit
/// trees begin with them. Requires an origin.
ColumnSquare tileset_columns(const WorldShape& shape, const TilesetPlace& place);

/// tileset.json. URLs in it are relative to it. `heights_m`: below (x) and above (y) which nothing of a column stands
/// at any LOD, for each of tileset_columns, row by row of z; of the whole world none.
std::string encode_tileset(const WorldShape& shape, const TilesetPlace& place, std::span<const glm::dvec2> heights_m);

}  // namespace talus::protocol
