// From a crossed lattice edge to a vertex: where it lies, where it faces, what it is made of.
//
// One maker for chunks and for the strips between them: a vertex that both have is the same to the bit. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/extract.hpp"
#include "core/world/density.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Densities of a box of samples, addressed by sample: (0, 0, 0) is the second of its columns on either axis, the first
/// being its halo; y counts from the box's own corner.
class Samples {
 public:
  Samples(const DensityBox& box, const float* density, int first_layer)
      : row_(static_cast<std::ptrdiff_t>(box.stride)), layer_(static_cast<std::ptrdiff_t>(box.stride * box.depth)) {
    origin_ = density - first_layer * layer_ + row_ + 1;
  }

  const float* row(int y, int z) const { return origin_ + y * layer_ + z * row_; }
  float at(int x, int y, int z) const { return row(y, z)[x]; }

  /// Gradient in halves of a cell by central differences. Every sample next to a crossed edge has its neighbours
  /// sampled.
  glm::vec3 gradient(int x, int y, int z) const {
    const float* p = row(y, z) + x;
    return {p[1] - p[-1], p[layer_] - p[-layer_], p[row_] - p[-row_]};
  }

 private:
  std::ptrdiff_t row_;
  std::ptrdiff_t layer_;
  const float* origin_;  ///< sample (0, 0, 0), which lies outside the array when its layer is not sampled
};

/// Layers of samples that the surface can touch, of -1 .. cells + 1, with two more on either side: one whose sign is
/// plain, one for normals. Samples below the interval are rock, those above it air. Of each row of columns by itself,
/// or of each part of each row, as `spans` has them (row_spans, part_spans): none where the surface stays a layer away
/// from 0 .. cells. Returns all together.
LayerInterval layers_near_surface(const ColumnBlock& columns, std::span<const HeightSpan> spans, std::int64_t y_voxel,
                                  int cells, std::vector<LayerInterval>& out);

struct MeshVertex {
  glm::u16vec3 position;  ///< steps from sample (0, 0, 0)
  glm::vec3 normal;
  std::uint8_t material = 0;
  std::uint8_t ridge = 0;
};

/// Makes vertices on the edges of one box of samples; `y_voxel` is where its y = 0 stands. All must outlive the maker.
class VertexMaker {
 public:
  VertexMaker(const WorldFunction& world, const ColumnBlock& columns, const Samples& samples, std::int64_t y_voxel);

  MeshVertex operator()(const CrossedEdge& edge) const;

 private:
  std::size_t column(int x, int z) const {
    return static_cast<std::size_t>(z + 1) * columns_.stride + static_cast<std::size_t>(x + 1);
  }

  const WorldFunction& world_;
  const ColumnBlock& columns_;
  const Samples& samples_;
  float step_m_ = 0;
  float y_m_ = 0;
};

}  // namespace talus
