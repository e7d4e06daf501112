// Where a ray first meets the surface. Pure.
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/strata/material.hpp"
#include "core/world/density_brick.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Longest ray, in voxels: 10 km of metre-voxels pass some 1800 bricks, below 0.1 s of CPU.
inline constexpr double kRayVoxelsMax = 10'000.0;

struct RayHit {
  double distance_m = 0;
  glm::dvec3 position_m{};
  glm::dvec3 normal{};  ///< unit, towards the air
  Material material = Material::kRock;
};

/// The first point along the ray whose density, trilinear between the samples of LOD 0, is not positive; distance 0
/// when `from_m` lies in rock. Nothing within `max_m`. Requires a direction of length 1 and max_m within kRayVoxelsMax.
std::optional<RayHit> cast_ray(const WorldFunction& world, const glm::dvec3& from_m, const glm::dvec3& direction,
                               double max_m, DensityBrick& brick);

}  // namespace talus
