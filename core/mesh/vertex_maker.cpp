#include "core/mesh/vertex_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

glm::vec3 unit(const glm::vec3& v) {
  const float length2 = v.x * v.x + v.y * v.y + v.z * v.z;
  if (!(length2 > 0.0f)) return {0.0f, 1.0f, 0.0f};
  const float inverse = 1.0f / std::sqrt(length2);
  return {v.x * inverse, v.y * inverse, v.z * inverse};
}

LayerInterval layers_within(const HeightSpan& span, const ColumnGrid& grid, std::int64_t y_voxel, int cells) {
  const double step_m = static_cast<double>(grid.step_voxel) * grid.voxel_m;
  const double y_m = static_cast<double>(y_voxel) * grid.voxel_m;
  const auto layer = [&](float height_m) { return std::floor((static_cast<double>(height_m) - y_m) / step_m); };
  const double limit = cells + 1;
  if (layer(span.high_m) + 1.0 < 0.0) return {-1, 0};
  if (layer(span.low_m) - 1.0 > static_cast<double>(cells)) return {cells + 2, 0};
  const auto first = static_cast<int>(std::clamp(layer(span.low_m) - 2.0, -1.0, limit));
  const auto last = static_cast<int>(std::clamp(layer(span.high_m) + 3.0, -1.0, limit));
  return {first, last - first + 1};
}

}  // namespace

LayerInterval layers_near_surface(const ColumnBlock& columns, std::span<const HeightSpan> spans, std::int64_t y_voxel,
                                  int cells, std::vector<LayerInterval>& out) {
  out.resize(spans.size());
  const auto rows = static_cast<std::size_t>(columns.grid.depth);
  const std::size_t parts = spans.size() / rows;
  LayerInterval all{cells + 1, 0};
  int all_end = -1;
  for (std::size_t at = 0; at < spans.size(); ++at) {
    // A row is read for its own vertices, for those of edges towards it and for the normals of both.
    const std::size_t k = at / parts;
    const std::size_t end = std::min(k + 3, rows);
    HeightSpan near = spans[at];
    for (std::size_t n = k < 2 ? 0 : k - 2; n < end; ++n) {
      const HeightSpan& beside = spans[n * parts + at % parts];
      near = {std::min(near.low_m, beside.low_m), std::max(near.high_m, beside.high_m)};
    }
    out[at] = layers_within(near, columns.grid, y_voxel, cells);
    if (out[at].count == 0) continue;
    all.first = std::min(all.first, out[at].first);
    all_end = std::max(all_end, out[at].first + out[at].count);
  }
  all.count = std::max(0, all_end - all.first);
  return all;
}

VertexMaker::VertexMaker(const WorldFunction& world, const ColumnBlock& columns, const Samples& samples,
                         std::int64_t y_voxel)
    : world_(world), columns_(columns), samples_(samples) {
  step_m_ = static_cast<float>(static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m);
  y_m_ = static_cast<float>(static_cast<double>(y_voxel) * columns.grid.voxel_m);
}

MeshVertex VertexMaker::operator()(const CrossedEdge& e) const {
  const std::array<int, 3> to{e.x + (e.axis == 0 ? 1 : 0), e.y + (e.axis == 1 ? 1 : 0), e.z + (e.axis == 2 ? 1 : 0)};
  const int step = crossing_step(samples_.at(e.x, e.y, e.z), samples_.at(to[0], to[1], to[2]));
  const float t = static_cast<float>(step) / static_cast<float>(kStepsPerCell);

  glm::u16vec3 position{e.x * kStepsPerCell, e.y * kStepsPerCell, e.z * kStepsPerCell};
  position[e.axis] = static_cast<std::uint16_t>(position[e.axis] + step);
  const glm::vec3 from_gradient = samples_.gradient(e.x, e.y, e.z);
  const glm::vec3 to_gradient = samples_.gradient(to[0], to[1], to[2]);
  const glm::vec3 normal = unit(from_gradient + (to_gradient - from_gradient) * t);

  const std::size_t from_column = column(e.x, e.z);
  const std::size_t to_column = column(to[0], to[2]);
  const float ridge = columns_.ridge[from_column] + (columns_.ridge[to_column] - columns_.ridge[from_column]) * t;
  const float height_m = y_m_ + (static_cast<float>(position.y) / static_cast<float>(kStepsPerCell)) * step_m_;
  const glm::i64vec2 column_voxel{columns_.grid.x_voxel + (e.x + 1) * columns_.grid.step_voxel,
                                  columns_.grid.z_voxel + (e.z + 1) * columns_.grid.step_voxel};
  const float from_top_m = top_m(columns_, from_column);
  const float over_m = from_top_m + (top_m(columns_, to_column) - from_top_m) * t;
  Material material =
      over_m - height_m > kUnderRoof_m
          ? world_.sheltered(height_m, normal.y)
          : world_.cover({height_m, normal.y, ridge, columns_.hilliness[from_column], columns_.beach[from_column],
                          column_voxel, columns_.districts_at(from_column), columns_.grid.step_voxel});

  if (material == Material::kRock) {
    const float stack_m =
        columns_.stack_m[from_column] + (columns_.stack_m[to_column] - columns_.stack_m[from_column]) * t;
    material = world_.rock({stack_m, columns_.choice[from_column], height_m, column_voxel, columns_.grid.step_voxel});
  }
  return {position, normal, static_cast<std::uint8_t>(material), ridge_byte(ridge)};
}

}  // namespace talus
