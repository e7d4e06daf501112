#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/check.hpp"
#include "core/volume/warp.hpp"
#include "core/world/terms.hpp"
#include "core/world/volume_scratch.hpp"

namespace talus {
namespace {

/// The world's surface, evaluated in a block of the caller's.
class WorldHeights final : public HeightSource {
 public:
  WorldHeights(const WorldFunction& world, ColumnBlock& block) : world_(world), block_(block) {}
  std::uint64_t identity() const override { return world_.terms().identity; }
  double voxel_m() const override { return world_.voxel_m(); }
  std::span<const float> heights(const ColumnGrid& grid) override {
    world_.columns(grid, block_);
    return block_.height_m;
  }
  std::optional<float> ceiling_near(double x_m, double z_m, float height_m) override {
    const auto voxel = [&](double at_m) { return static_cast<std::int64_t>(std::floor(at_m / world_.voxel_m())); };
    world_.columns({voxel(x_m), voxel(z_m), 1, 1, 1, world_.voxel_m()}, block_);
    return world_.terms().profile->ceiling_near(block_.stack_m[0], block_.choice[0], height_m);
  }

 private:
  const WorldFunction& world_;
  ColumnBlock& block_;
};

}  // namespace

void WorldFunction::volume(ColumnBlock& block, VolumeScratch& scratch) const {
  const Terms& t = *terms_;
  block.rock_below_m = block.height_low_m;
  block.air_above_m = block.height_high_m;
  block.has_jut = false;
  block.has_volume = true;
  block.spheres.clear();
  // Grids of coarse LODs see neither: they do not even ask for tiles.
  if (lies_on(block.grid, kStill_m)) return;
  WorldHeights heights(*this, scratch.nodes);
  Relief relief(heights, scratch.relief);
  block.jut_m.resize(sample_count(block.grid));
  block.has_jut = warp_columns(t.warp, relief, block.grid, block.height_m.data(), scratch.patch, block.jut_m.data());
  gather_spheres(t.carve, relief, scratch.carve, block.grid, block.spheres);
  const float swell_m = carve_swell_m(t.carve);
  for (const CarveSphere& s : block.spheres)
    block.rock_below_m = std::min(block.rock_below_m, s.y_m - (s.radius_m + swell_m) / s.inverse_stretch);
  if (!block.has_jut) return;
  for (int k = 0; k < block.grid.depth; ++k) {
    const std::size_t row = static_cast<std::size_t>(k) * block.stride;
    for (std::size_t i = row; i < row + static_cast<std::size_t>(block.grid.width); ++i)
      block.air_above_m = std::max(block.air_above_m, block.height_m[i] + block.jut_m[i]);
  }
}

}  // namespace talus
