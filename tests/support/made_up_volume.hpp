// The volume over a made-up surface: columns, warp, spheres and densities as the world function puts them together, for
// tests that need cliffs wherever the world has none.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "client_sample/cli/rock_block.hpp"
#include "core/strata/hardness_profile.hpp"
#include "core/volume/field.hpp"
#include "core/volume/warp.hpp"
#include "core/world/terms.hpp"
#include "tests/support/cliff_coast.hpp"

namespace talus::test {

class MadeUpVolume {
 public:
  /// `heights` must outlive this. Controls are those of the default manifest but for their seeds, and free to be
  /// changed.
  explicit MadeUpVolume(CliffCoast& heights)
      : warp(warp_of(Manifest())),
        carve(carve_of(Manifest())),
        heights_(heights),
        strata_({2, 1.5f, 0.25f, 9}),
        profile_(strata_) {
    warp.seed = 1;
    carve.seed = 2;
  }

  WarpControls warp;
  CarveControls carve;

  struct Columns {
    ColumnGrid grid;
    std::vector<float> height, steepness, jut, stack, choice;
    std::vector<CarveSphere> spheres;
    bool has_jut = false;
  };
  struct Memory {
    ReliefMemory relief;
    CarveMemory carve;
    FieldMemory field;
    std::vector<float> patch;
  };

  Columns columns(const ColumnGrid& grid, Memory& memory) const {
    Columns out;
    out.grid = grid;
    const std::size_t stride = row_stride(grid);
    const std::size_t count = sample_count(grid);
    out.steepness.resize(count);
    out.stack.resize(count);
    out.choice.resize(count);
    out.jut.resize(count);
    const auto heights = heights_.heights(grid);
    out.height.assign(heights.begin(), heights.end());
    for (std::size_t n = 0; n < count; ++n) {
      out.steepness[n] = heights_.steepness(grid, n % stride, n / stride);
      const auto x = static_cast<float>(grid.x_voxel + static_cast<std::int64_t>(n % stride) * grid.step_voxel);
      out.stack[n] = 3600.0f + 0.03f * x;
      out.choice[n] = 0.5f;
    }
    Relief relief(heights_, memory.relief);
    out.has_jut = warp_columns(warp, relief, grid, out.height.data(), memory.patch, out.jut.data());
    gather_spheres(carve, relief, memory.carve, grid, out.spheres);
    return out;
  }

  /// Densities of `layers` from voxel `y_voxel` up, at the grid's step; sample (i, j, k) is at (j * depth + k) * width
  /// + i.
  std::vector<float> sample(const Columns& c, std::int64_t y_voxel, int layers, Memory& memory) const {
    const auto width = static_cast<std::size_t>(c.grid.width);
    const FieldColumns columns{c.grid,         c.height.data(), c.steepness.data(), c.has_jut ? c.jut.data() : nullptr,
                               c.stack.data(), c.choice.data(), c.spheres};
    Field field(profile_, carve, columns, memory.field);
    std::vector<float> row(row_stride(c.grid));
    std::vector<float> out;
    out.reserve(width * static_cast<std::size_t>(c.grid.depth * layers));
    for (int j = 0; j < layers; ++j) {
      field.layer(y_voxel + j * c.grid.step_voxel);
      for (int k = 0; k < c.grid.depth; ++k) {
        field.row(k, row.data());
        out.insert(out.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(width));
      }
    }
    return out;
  }

  /// Voxels of 1 m from (x, y, z) on, evaluated in tiles as chunks are. Width and depth are multiples of 64.
  cli::RockBlock block(std::int64_t x, std::int64_t y, std::int64_t z, int width, int height, int depth,
                       Memory& memory) const {
    constexpr int kTile = 64;
    cli::RockBlock out{width, height, depth, {}};
    out.rock.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                    static_cast<std::size_t>(depth));
    for (int dz = 0; dz < depth; dz += kTile) {
      for (int dx = 0; dx < width; dx += kTile) {
        const Columns c = columns({x + dx, z + dz, 1, kTile, kTile, heights_.voxel_m()}, memory);
        const std::vector<float> samples = sample(c, y, height, memory);
        std::size_t n = 0;
        for (int j = 0; j < height; ++j) {
          for (int k = 0; k < kTile; ++k) {
            for (int i = 0; i < kTile; ++i, ++n) out.rock[out.at(dx + i, j, dz + k)] = samples[n] < 0.0f ? 1 : 0;
          }
        }
      }
    }
    return out;
  }

 private:
  CliffCoast& heights_;
  Strata strata_;
  HardnessProfile profile_;
};

}  // namespace talus::test
