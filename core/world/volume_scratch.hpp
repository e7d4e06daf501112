// Working memory for warp, carving and densities. One per thread; tiles that were evaluated once are remembered in it,
// in tables of fixed size (1.6 MB), for any number of worlds. What is read never depends on what is remembered.
#pragma once

#include <vector>

#include "core/volume/carve_spheres.hpp"
#include "core/volume/field.hpp"
#include "core/volume/relief_tiles.hpp"
#include "core/world/world_function.hpp"

namespace talus {

struct VolumeScratch {
  ReliefMemory relief;
  CarveMemory carve;
  FieldMemory field;
  ColumnBlock nodes;         ///< of the tile that is being evaluated
  std::vector<float> patch;  ///< noise of warp
};

}  // namespace talus
