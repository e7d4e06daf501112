#include "core/world/density_brick.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

void DensityBrick::stand(const WorldFunction& world, std::int64_t x_voxel, std::int64_t z_voxel, std::int64_t step,
                         int cells) {
  world.columns({x_voxel, z_voxel, step, cells + 1, cells + 1, world.voxel_m()}, columns_);
  world.volume(columns_, volume_);
}

void DensityBrick::sample(const WorldFunction& world, std::int64_t y_voxel, int layers) {
  const std::size_t floats = density_floats(columns_.grid, layers);
  samples_.resize(std::max(samples_.size(), floats));
  box_ = sample_density(world, columns_, y_voxel, layers, {}, volume_, samples_);
}

std::array<float, 8> DensityBrick::corners(int i, int j, int k) const {
  const std::size_t layer = box_.depth * box_.stride;
  const float* low = &samples_[static_cast<std::size_t>(j) * layer + static_cast<std::size_t>(k) * box_.stride +
                               static_cast<std::size_t>(i)];
  const float* high = low + layer;
  return {low[0],
          low[1],
          high[0],
          high[1],
          low[box_.stride],
          low[box_.stride + 1],
          high[box_.stride],
          high[box_.stride + 1]};
}

double DensityBrick::density(const glm::dvec3& place_cells) const {
  const auto cell = [](double at, int last) { return std::clamp(static_cast<int>(std::floor(at)), 0, last); };
  const int i = cell(place_cells.x, columns_.grid.width - 2);
  const int j = cell(place_cells.y, box_.layers - 2);
  const int k = cell(place_cells.z, columns_.grid.depth - 2);
  return trilinear(corners(i, j, k), place_cells - glm::dvec3(i, j, k));
}

double trilinear(const std::array<float, 8>& corners, const glm::dvec3& at) {
  const auto along_x = [&](std::size_t c) {
    return static_cast<double>(corners[c]) +
           (static_cast<double>(corners[c + 1]) - static_cast<double>(corners[c])) * at.x;
  };
  const double front = along_x(0) + (along_x(2) - along_x(0)) * at.y;
  const double back = along_x(4) + (along_x(6) - along_x(4)) * at.y;
  return front + (back - front) * at.z;
}

glm::dvec3 trilinear_gradient(const std::array<float, 8>& corners, const glm::dvec3& at) {
  // A trilinear function is linear along each axis: its slope there is the difference of its ends.
  const auto slope = [&](int axis) {
    glm::dvec3 from = at;
    glm::dvec3 to = at;
    from[axis] = 0;
    to[axis] = 1;
    return trilinear(corners, to) - trilinear(corners, from);
  };
  return {slope(0), slope(1), slope(2)};
}

}  // namespace talus
