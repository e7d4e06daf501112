// A box of a world at LOD 0, sample by sample: what searches and pictures of single cliffs look into. Deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "client_sample/cli/rock_block.hpp"
#include "core/world/density_brick.hpp"
#include "core/world/world_function.hpp"

namespace talus::cli {

/// Densities of width x height x depth voxels from `corner_voxel` on, negative in rock; x varies fastest, then z, then
/// y.
struct WorldBlock {
  glm::i64vec3 corner_voxel{};
  int width = 0, height = 0, depth = 0;
  std::vector<float> density;
  /// Of each column, x fastest, then z: surface without volume, top of the rock layers' stack, choice of layer sets.
  std::vector<float> height_m, stack_m, choice;

  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(depth) + static_cast<std::size_t>(z)) *
               static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Samples the block, whose corner and size are set. `brick` is memory, the better the nearer the last block was.
void sample_block(const WorldFunction& world, DensityBrick& brick, WorldBlock& block);

/// Which of its voxels are rock.
RockBlock rock_of(const WorldBlock& block);

}  // namespace talus::cli
