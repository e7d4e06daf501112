// Densities between lattice points: a few cells of the field, read anywhere inside them. Pure; memory is the caller's.
//
// Between samples the field is trilinear, as marching cubes assumes along its edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/world/density.hpp"
#include "core/world/world_function.hpp"

namespace talus {

class DensityBrick {
 public:
  /// Columns of `cells` x `cells` lattice cells from (x_voxel, z_voxel), `step` voxels wide; both on the lattice of
  /// `step`. Densities are unset until `sample`.
  void stand(const WorldFunction& world, std::int64_t x_voxel, std::int64_t z_voxel, std::int64_t step, int cells);

  /// Above the second and at or below the first there is no surface: metres.
  double rock_below_m() const { return static_cast<double>(columns_.rock_below_m); }
  double air_above_m() const { return static_cast<double>(columns_.air_above_m); }

  /// Densities of `layers` samples from y_voxel upwards, on the lattice too. Requires stand() in this world.
  void sample(const WorldFunction& world, std::int64_t y_voxel, int layers);

  /// Densities at the corners of cell (i, j, k), j from the lowest sampled layer; x fastest, then y, then z.
  std::array<float, 8> corners(int i, int j, int k) const;
  /// At a point in cells from the brick's lowest corner, all of it inside.
  double density(const glm::dvec3& place_cells) const;

  const ColumnBlock& columns() const { return columns_; }

 private:
  ColumnBlock columns_;
  VolumeScratch volume_;
  std::vector<float> samples_;
  DensityBox box_;
};

/// Trilinear between the corners of a cell, at fractions 0..1 of its edges.
double trilinear(const std::array<float, 8>& corners, const glm::dvec3& at);
/// Its gradient, per cell edge.
glm::dvec3 trilinear_gradient(const std::array<float, 8>& corners, const glm::dvec3& at);

}  // namespace talus
