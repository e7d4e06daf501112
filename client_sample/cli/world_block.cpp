#include "client_sample/cli/world_block.hpp"

#include <algorithm>

namespace talus::cli {
namespace {

constexpr int kTile = 64;

void keep_columns(const ColumnBlock& from, int x0, int z0, WorldBlock& block) {
  for (int z = z0; z < std::min(z0 + kTile, block.depth); ++z) {
    for (int x = x0; x < std::min(x0 + kTile, block.width); ++x) {
      const std::size_t at = static_cast<std::size_t>(z - z0) * from.stride + static_cast<std::size_t>(x - x0);
      const std::size_t to = block.at(x, 0, z);
      block.height_m[to] = from.height_m[at];
      block.stack_m[to] = from.stack_m[at];
      block.choice[to] = from.choice[at];
    }
  }
}

}  // namespace

void sample_block(const WorldFunction& world, DensityBrick& brick, WorldBlock& block) {
  block.density.resize(block.at(0, block.height, 0));
  for (auto* array : {&block.height_m, &block.stack_m, &block.choice}) array->resize(block.at(0, 1, 0));
  for (int dz = 0; dz < block.depth; dz += kTile) {
    for (int dx = 0; dx < block.width; dx += kTile) {
      const int cells = std::min(kTile, std::max(block.width - dx, block.depth - dz));
      brick.stand(world, block.corner_voxel.x + dx, block.corner_voxel.z + dz, 1, cells);
      brick.sample(world, block.corner_voxel.y, block.height + 1);
      keep_columns(brick.columns(), dx, dz, block);
      for (int y = 0; y < block.height; ++y) {
        for (int z = dz; z < std::min(dz + kTile, block.depth); ++z) {
          for (int x = dx; x < std::min(dx + kTile, block.width); ++x) {
            block.density[block.at(x, y, z)] = brick.corners(x - dx, y, z - dz)[0];
          }
        }
      }
    }
  }
}

RockBlock rock_of(const WorldBlock& block) {
  RockBlock out{block.width, block.height, block.depth, std::vector<std::uint8_t>(block.density.size())};
  std::ranges::transform(block.density, out.rock.begin(), [](float d) -> std::uint8_t { return d < 0 ? 1 : 0; });
  return out;
}

}  // namespace talus::cli
