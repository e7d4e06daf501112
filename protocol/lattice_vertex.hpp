// A vertex of marching cubes in eight bytes. SPEC.md, "Mesh payload". Pure.
//
// It lies on an edge of a cell, so two of its coordinates are whole cells: one byte each, and one for the axis of the
// edge and the steps along it. Its normal is octahedral around +y, where terrain mostly faces: no seam of the map runs
// through ground that faces up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "core/mesh/chunk_mesh.hpp"

namespace talus::protocol {

struct LatticeVertex {
  std::array<std::uint8_t, 3> cell{};   ///< where its edge begins
  std::uint8_t edge = 0;                ///< axis of the edge in bits 6 and 7, steps along it below
  std::array<std::int8_t, 2> normal{};  ///< octahedral, x and z
  std::uint8_t material = 0;
  std::uint8_t ridge = 0;
};
static_assert(sizeof(LatticeVertex) == 8 && kStepsPerCell == 64);

/// Cells along an edge of the lattice that a byte counts, the last sample included.
inline constexpr int kLatticeCellsMax = 255;

/// Requires that at most one coordinate is no whole cell, and that none is above kLatticeCellsMax cells.
LatticeVertex pack_vertex(const glm::u16vec3& position, const glm::vec3& normal, std::uint8_t material,
                          std::uint8_t ridge);

/// Steps from the lowest corner; nothing where it is not within `cells`.
std::optional<glm::u16vec3> position_of(const LatticeVertex& vertex, int cells);

/// Of length 1, the same bits on every machine.
glm::vec3 normal_of(const LatticeVertex& vertex);

}  // namespace talus::protocol
