#include "protocol/lattice_vertex.hpp"

#include <cmath>

#include "core/base/check.hpp"

namespace talus::protocol {
namespace {

constexpr float kNormalScale = 127.0F;
constexpr unsigned kAxisShift = 6;

float with_sign_of(float magnitude, float sign) {
  return sign < 0.0F ? -magnitude : magnitude;
}

/// Folds the lower half of the octahedron outwards; its own inverse.
void fold(float& u, float& v) {
  const float folded = with_sign_of(1.0F - std::abs(v), u);
  v = with_sign_of(1.0F - std::abs(u), v);
  u = folded;
}

}  // namespace

LatticeVertex pack_vertex(const glm::u16vec3& position, const glm::vec3& normal, std::uint8_t material,
                          std::uint8_t ridge) {
  LatticeVertex out;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = position[axis] / kStepsPerCell;
    const auto step = static_cast<unsigned>(position[axis] % kStepsPerCell);
    TALUS_CHECK(cell <= kLatticeCellsMax && (step == 0 || out.edge == 0));
    out.cell[static_cast<std::size_t>(axis)] = static_cast<std::uint8_t>(cell);
    if (step != 0) out.edge = static_cast<std::uint8_t>(static_cast<unsigned>(axis) << kAxisShift | step);
  }
  const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  float u = normal.x / sum;
  float v = normal.z / sum;
  if (normal.y < 0.0F) fold(u, v);
  out.normal = {static_cast<std::int8_t>(std::floor(u * kNormalScale + 0.5F)),
                static_cast<std::int8_t>(std::floor(v * kNormalScale + 0.5F))};
  out.material = material;
  out.ridge = ridge;
  return out;
}

std::optional<glm::u16vec3> position_of(const LatticeVertex& vertex, int cells) {
  const int axis = vertex.edge >> kAxisShift;
  if (axis > 2) return std::nullopt;
  glm::ivec3 steps(vertex.cell[0], vertex.cell[1], vertex.cell[2]);
  steps *= kStepsPerCell;
  steps[axis] += vertex.edge & (kStepsPerCell - 1);
  for (int i = 0; i < 3; ++i) {
    if (steps[i] > cells * kStepsPerCell) return std::nullopt;
  }
  return glm::u16vec3(steps);
}

glm::vec3 normal_of(const LatticeVertex& vertex) {
  float u = static_cast<float>(vertex.normal[0]) / kNormalScale;
  float v = static_cast<float>(vertex.normal[1]) / kNormalScale;
  const float y = 1.0F - std::abs(u) - std::abs(v);
  if (y < 0.0F) fold(u, v);
  const float inverse = 1.0F / std::sqrt(u * u + y * y + v * v);
  return {u * inverse, y * inverse, v * inverse};
}

}  // namespace talus::protocol
