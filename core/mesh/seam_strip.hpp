// The seam strip of one face of a chunk: what closes it to the finer chunks across that face. Pure; memory is the
// caller's.
//
// Based on: E. Lengyel, "Voxel-Based Terrain for Real-Time Virtual Simulations", 2010 (a coarse cell whose neighbour is
// finer reads nine samples of its face). What differs: the cell has no width. Nothing of either mesh moves, so a chunk
// is one mesh whatever its neighbours are, and a strip is added or left away alone (see seam_cell.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/grid/chunk_face.hpp"
#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "core/world/density.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Fills a block with the columns that `key` stands on (chunk_columns), evaluated or remembered, with or without their
/// volume.
using ColumnLoader = std::function<void(const ChunkKey& key, ColumnBlock& out)>;

/// Working memory of one thread. Once it has grown to its largest strip no call allocates.
struct StripScratch {
  struct Lattice {
    ColumnBlock columns;
    std::vector<float> density;
    std::vector<HeightSpan> spans;      ///< of the parts of its rows
    std::vector<LayerInterval> layers;  ///< the same: what is sampled
    std::vector<LayerInterval> wanted;  ///< the same, counted from the lowest layer that is sampled
  };
  Lattice fine;
  Lattice coarse;
  VolumeScratch volume;
  std::vector<std::uint8_t> rock;       ///< signs of the fine samples of a face
  std::vector<std::int32_t> vertex_of;  ///< by crossing; -1 where there is none yet
};

/// Fills `out` with the strip between `face` of `key` and the chunks one LOD finer across it, whether or not anybody
/// draws them: it depends on the key and the face alone. Empty where the surface does not cross the face, or crosses it
/// along one and the same line at both LODs. Densities are sampled near the surface alone, none where the heights of
/// the columns rule it out. Requires is_valid(key) and key.lod > 0.
///
/// Positions are in steps of the *finer* LOD's lattice, 0..2 * cells * kStepsPerCell from the lowest corner of `key`.
/// Every vertex is a vertex of the chunk or of one across the face, with its very normal, material and ridge. Triangles
/// lie in the face; some have no area, where a fine vertex lies on a coarse edge: they are what keeps that edge whole.
void build_strip(const WorldFunction& world, const ChunkKey& key, ChunkFace face, const ColumnLoader& columns,
                 StripScratch& scratch, ChunkMesh& out);

}  // namespace talus
