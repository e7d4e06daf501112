// Between which heights the ground of a column lies, for those who have to say so before any mesh of it is made. Pure.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "core/world/world_function.hpp"
#include "protocol/tileset.hpp"

namespace talus::server {

/// Below (x) and above (y) which nothing of a column stands at its own or any finer LOD, in metres, for each column of
/// the square, row by row of z. Samples of the column at its own LOD and a margin: see the source. About a millisecond
/// each.
std::vector<glm::dvec2> column_heights(const WorldFunction& world, const protocol::ColumnSquare& columns);

}  // namespace talus::server
