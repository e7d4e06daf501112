#include "core/mesh/build_chunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.hpp"

namespace talus {
namespace {

/// Densities of one chunk, addressed by sample, halo included (-1 .. cells + 1 along x and z, the sampled layers along
/// y).
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

struct LayerInterval {
  int first;  ///< of the samples -1 .. cells + 1
  int count;
};

/// Layers of samples that the surface can touch, with two more on either side: one whose sign is plain, one for
/// normals.
LayerInterval layers_near_surface(const ColumnBlock& columns, std::int64_t y_voxel, int cells) {
  const double step_m = static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m;
  const double y_m = static_cast<double>(y_voxel) * columns.grid.voxel_m;
  const auto layer = [&](float height_m) { return std::floor((static_cast<double>(height_m) - y_m) / step_m); };
  const double limit = cells + 1;
  const auto first = static_cast<int>(std::clamp(layer(columns.height_low_m) - 2.0, -1.0, limit));
  const auto last = static_cast<int>(std::clamp(layer(columns.height_high_m) + 3.0, -1.0, limit));
  return {first, last - first + 1};
}

/// Sign words of the (cells + 1)^3 samples. Layers under the sampled ones are rock, those above air.
void read_signs(const Samples& samples, const LayerInterval& layers, SignRows& out) {
  const int count = out.cells + 1;
  out.rows.resize(static_cast<std::size_t>(count * count));
  const std::uint64_t rock = (std::uint64_t{1} << count) - 1;
  for (int y = 0; y < count; ++y) {
    const bool below = y < layers.first;
    const bool sampled = !below && y < layers.first + layers.count;
    for (int z = 0; z < count; ++z) {
      std::uint64_t row = below ? rock : 0;
      if (sampled) {
        const float* values = samples.row(y, z);
        for (int x = 0; x < count; ++x) row |= static_cast<std::uint64_t>(values[x] < 0.0f) << x;
      }
      out.rows[static_cast<std::size_t>(y * count + z)] = row;
    }
  }
}

/// Makes the vertices of one chunk, in the order of its crossed edges, in arrays that are long enough.
class VertexMaker {
 public:
  VertexMaker(const WorldFunction& world, const ColumnBlock& columns, const Samples& samples, std::int64_t y_voxel,
              ChunkMesh& out)
      : world_(world), columns_(columns), samples_(samples), out_(out) {
    step_m_ = static_cast<float>(static_cast<double>(columns.grid.step_voxel) * columns.grid.voxel_m);
    y_m_ = static_cast<float>(static_cast<double>(y_voxel) * columns.grid.voxel_m);
  }

  void operator()(const CrossedEdge& e) {
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
    Material material = world_.cover(height_m, normal.y, ridge, columns_.hilliness[from_column], column_voxel);

    if (material == Material::kRock) {
      const float stack_m =
          columns_.stack_m[from_column] + (columns_.stack_m[to_column] - columns_.stack_m[from_column]) * t;
      material = world_.rock(stack_m, columns_.choice[from_column], height_m, column_voxel);
    }
    out_.positions[next_] = position;
    out_.normals[next_] = normal;
    out_.materials[next_] = static_cast<std::uint8_t>(material);
    out_.ridges[next_] = static_cast<std::uint8_t>(std::clamp(ridge, -1.0f, 1.0f) * 127.0f + 128.0f);
    ++next_;
  }

 private:
  static glm::vec3 unit(const glm::vec3& v) {
    const float length2 = v.x * v.x + v.y * v.y + v.z * v.z;
    if (!(length2 > 0.0f)) return {0.0f, 1.0f, 0.0f};
    const float inverse = 1.0f / std::sqrt(length2);
    return {v.x * inverse, v.y * inverse, v.z * inverse};
  }
  std::size_t column(int x, int z) const {
    return static_cast<std::size_t>(z + 1) * columns_.stride + static_cast<std::size_t>(x + 1);
  }

  const WorldFunction& world_;
  const ColumnBlock& columns_;
  const Samples& samples_;
  ChunkMesh& out_;
  std::size_t next_ = 0;
  float step_m_ = 0;
  float y_m_ = 0;
};

}  // namespace

ColumnGrid chunk_columns(const WorldFunction& world, const ChunkKey& key) {
  const glm::i64vec3 corner = corner_voxel(key, world.cells());
  const std::int64_t step = std::int64_t{1} << key.lod;
  const int width = world.cells() + 3;
  return {corner.x - step, corner.z - step, step, width, width, world.voxel_m()};
}

ChunkKind kind_by_heights(const WorldFunction& world, const ChunkKey& key, double low_m, double high_m) {
  const BoxWorld box = box_of(key, world.cells(), world.voxel_m());
  if (high_m <= box.low.y) return ChunkKind::kAir;
  if (low_m > box.high.y) return ChunkKind::kRock;
  return ChunkKind::kMesh;
}

DensityBox sample_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch) {
  const std::int64_t y_voxel = corner_voxel(key, world.cells()).y;
  const LayerInterval layers = layers_near_surface(scratch.columns, y_voxel, world.cells());
  const std::size_t floats = density_floats(scratch.columns.grid, layers.count);
  scratch.density.resize(std::max(scratch.density.size(), floats));
  const std::int64_t first_voxel = y_voxel + layers.first * scratch.columns.grid.step_voxel;
  const DensityBox box = sample_density(scratch.columns, first_voxel, layers.count, scratch.density);
  scratch.signs.cells = world.cells();
  read_signs(Samples(box, scratch.density.data(), layers.first), layers, scratch.signs);
  return box;
}

ChunkKind mesh_chunk(const WorldFunction& world, const ChunkKey& key, const DensityBox& box, ChunkScratch& scratch,
                     ChunkMesh& out) {
  out.clear();
  find_crossed_edges(scratch.signs, scratch.edges);
  if (scratch.edges.vertices == 0) return scratch.signs.rows[0] == 0 ? ChunkKind::kAir : ChunkKind::kRock;
  extract_triangles(scratch.signs, scratch.edges, out.indices);
  const std::int64_t y_voxel = corner_voxel(key, world.cells()).y;
  const auto first_layer = static_cast<int>((box.y_voxel - y_voxel) / scratch.columns.grid.step_voxel);
  const Samples samples(box, scratch.density.data(), first_layer);
  out.positions.resize(scratch.edges.vertices);
  out.normals.resize(scratch.edges.vertices);
  out.materials.resize(scratch.edges.vertices);
  out.ridges.resize(scratch.edges.vertices);
  for_each_crossed_edge(scratch.signs, scratch.edges, VertexMaker(world, scratch.columns, samples, y_voxel, out));
  return ChunkKind::kMesh;
}

ChunkKind build_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch, ChunkMesh& out) {
  TALUS_CHECK(is_valid(key));
  out.clear();
  const glm::dvec2 range = world.height_range_m();
  if (const ChunkKind kind = kind_by_heights(world, key, range.x, range.y); kind != ChunkKind::kMesh) return kind;
  world.columns(chunk_columns(world, key), scratch.columns);
  const auto low_m = static_cast<double>(scratch.columns.height_low_m);
  const auto high_m = static_cast<double>(scratch.columns.height_high_m);
  if (const ChunkKind kind = kind_by_heights(world, key, low_m, high_m); kind != ChunkKind::kMesh) return kind;
  return mesh_chunk(world, key, sample_chunk(world, key, scratch), scratch, out);
}

}  // namespace talus
