// The field itself over one chunk, for engines that mesh, carve or collide on their own. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/build_chunk.hpp"

namespace talus {

/// Density steps per cell edge: four times finer than the lattice of vertices, so that crossings computed from them are
/// within a step of the mesh's once they are held kCrossingMarginSteps off the ends of their edges.
inline constexpr int kDensityStepsPerCell = 256;
/// Densities are held within [-kDensityHeld, kDensityHeld - 1] steps, 8 cells either way: brushes and blends see a true
/// distance around the surface, and what lies beyond costs no bytes.
inline constexpr int kDensityHeld = 8 * kDensityStepsPerCell;
/// Material of a sample in the air.
inline constexpr std::uint8_t kNoMaterial = 255;

/// (cells + 1)^3 samples; sample (i, j, k) along x, y, z is at (j * (cells + 1) + k) * (cells + 1) + i.
struct DensityTile {
  int cells = 0;
  double step_m = 0.0;  ///< a power of two
  /// floor(density / step), held within kDensityHeld: the sign is exact, and (value + 0.5) * step is the density to
  /// half a step.
  std::vector<std::int16_t> densities;
  /// What rock is made of; where air is one sample away, what lies on it. kNoMaterial in the air.
  std::vector<std::uint8_t> materials;
};

/// Fills `out` from the columns of `key`'s chunk, already in `scratch`. kAir or kRock, and `out` unspecified, when
/// every sample of the chunk has one sign.
ChunkKind sample_density_tile(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch, DensityTile& out);

}  // namespace talus
