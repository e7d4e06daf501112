// A block of voxels, rock or air, and a repeatable search in it: arches, caves, overhangs and detached rock.
//
// Slice the block at one height: a cell is rock, open air, or covered air (rock somewhere above it). A 4-connected
// component of covered air of at least 12 cells is a cavity; its cells next to open air, linked within two cells, form
// mouths, those of at least 3 cells count. An arch is a cavity with two mouths or more and a mean clearance of at least
// 3 m; a cave has one mouth and a cell at least 8 cells from it. A notch is one long mouth and is not counted. Counts
// depend on the slice: compare only equal slices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus::cli {

/// Bits of 1 m voxels; x varies fastest, then z, then y.
struct RockBlock {
  int width = 0, height = 0, depth = 0;
  std::vector<std::uint8_t> rock;

  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(depth) + static_cast<std::size_t>(z)) *
               static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

struct Cavity {
  int x = 0, z = 0;  ///< a cell of it
  int cells = 0;
  int mouths = 0;
  int depth = 0;  ///< of its innermost cell, in cells from a mouth
  double clearance = 0;
  bool is_arch() const { return mouths >= 2 && clearance >= 3.0; }
  bool is_cave() const { return mouths == 1 && depth >= 8; }
};

/// Cavities in layer `y`, in order of their first cell.
std::vector<Cavity> find_cavities(const RockBlock& block, int y);

/// Columns with rock over at least `gap` voxels of air over rock.
int count_overhangs(const RockBlock& block, int gap);

/// Sizes, in voxels, of 6-connected rock that reaches neither the block's bottom nor its sides; largest first.
std::vector<int> find_detached(const RockBlock& block);

/// Cells of rock in layer `y` next to air in it: about the length of the coast.
int coast_cells(const RockBlock& block, int y);

/// Those of them with rock `rise` voxels higher up within `reach` cells to any of the four sides: cliffs.
int cliff_cells(const RockBlock& block, int y, int rise, int reach);

}  // namespace talus::cli
