// Questions about places: where to stand, what the ground is. Milliseconds each, so they run on the pool. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/world/world_function.hpp"

namespace talus::server {

inline constexpr std::size_t kPointsMax = 1000;

/// Places asked for reach +-this, in metres: the edge of the world less the 300 km that a search may walk.
double place_limit_m(const WorldFunction& world);

/// A place to stand on dry land near `near_m` (x, z), each within place_limit_m: higher than 2 m, slope below 0.5. The
/// search widens from 0.5 km to about 130 km; nothing when all of that is sea or cliff.
std::optional<glm::dvec3> standing_place(const WorldFunction& world, const glm::dvec2& near_m);

/// The body of GET /v1/worlds/{world}/points: height, slope, material, layer and ridge at each place (x, z). Between
/// lattice columns heights are interpolated linearly.
std::string points_json(const WorldFunction& world, std::span<const glm::dvec2> places_m);

/// Longest ray of GET /v1/worlds/{world}/ray, in metres.
double ray_limit_m(const WorldFunction& world);

/// The body of GET /v1/worlds/{world}/ray: where the ray first meets the surface, or `null`. `direction` has length 1;
/// `max_m` is within ray_limit_m.
std::string ray_json(const WorldFunction& world, const glm::dvec3& from_m, const glm::dvec3& direction, double max_m);

}  // namespace talus::server
