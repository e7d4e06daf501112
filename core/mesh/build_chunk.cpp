#include "core/mesh/build_chunk.hpp"

#include <algorithm>

#include "core/base/check.hpp"
#include "core/grid/chunk_face.hpp"
#include "core/mesh/vertex_maker.hpp"

namespace talus {
namespace {

/// Sign words of the (cells + 1)^3 samples. Layers under a row's sampled ones are rock, those above air.
void read_signs(const Samples& samples, const std::vector<LayerInterval>& row_layers, SignRows& out) {
  const int count = out.cells + 1;
  out.rows.resize(static_cast<std::size_t>(count * count));
  const std::uint64_t rock = (std::uint64_t{1} << count) - 1;
  for (int y = 0; y < count; ++y) {
    for (int z = 0; z < count; ++z) {
      const LayerInterval& layers = row_layers[static_cast<std::size_t>(z + 1)];
      const bool below = y < layers.first;
      const bool sampled = !below && y < layers.first + layers.count;
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
class VertexWriter {
 public:
  VertexWriter(const VertexMaker& maker, ChunkMesh& out) : maker_(maker), out_(out) {}

  void operator()(const CrossedEdge& edge) {
    const MeshVertex vertex = maker_(edge);
    out_.positions[next_] = vertex.position;
    out_.normals[next_] = vertex.normal;
    out_.materials[next_] = vertex.material;
    out_.ridges[next_] = vertex.ridge;
    ++next_;
  }

 private:
  const VertexMaker& maker_;
  ChunkMesh& out_;
  std::size_t next_ = 0;
};

}  // namespace

unsigned faces_reached(const ChunkMesh& mesh, int cells) {
  const int edge = cells * kStepsPerCell;
  unsigned out = 0;
  for (const glm::u16vec3& position : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned high = bit_of(static_cast<ChunkFace>(2 * axis));
      if (position[axis] == edge) out |= high;
      if (position[axis] == 0) out |= high << 1;
    }
  }
  return out;
}

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
  row_spans(world, scratch.columns, scratch.spans);
  const LayerInterval all = layers_near_surface(scratch.columns, scratch.spans, y_voxel, world.cells(), scratch.layers);
  const std::size_t floats = density_floats(scratch.columns.grid, all.count);
  scratch.density.resize(std::max(scratch.density.size(), floats));
  scratch.wanted = scratch.layers;
  for (LayerInterval& row : scratch.wanted) row.first -= all.first;
  const std::int64_t first_voxel = y_voxel + all.first * scratch.columns.grid.step_voxel;
  const DensityBox box =
      sample_density(world, scratch.columns, first_voxel, all.count, scratch.wanted, scratch.volume, scratch.density);
  scratch.signs.cells = world.cells();
  read_signs(Samples(box, scratch.density.data(), all.first), scratch.layers, scratch.signs);
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
  const VertexMaker maker(world, scratch.columns, samples, y_voxel);
  for_each_crossed_edge(scratch.signs, scratch.edges, VertexWriter(maker, out));
  return ChunkKind::kMesh;
}

ChunkKind build_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch, ChunkMesh& out) {
  TALUS_CHECK(is_valid(key));
  out.clear();
  const glm::dvec2 range = world.height_range_m();
  if (const ChunkKind kind = kind_by_heights(world, key, range.x, range.y); kind != ChunkKind::kMesh) return kind;
  world.columns(chunk_columns(world, key), scratch.columns);
  world.volume(scratch.columns, scratch.volume);
  const auto low_m = static_cast<double>(scratch.columns.rock_below_m);
  const auto high_m = static_cast<double>(scratch.columns.air_above_m);
  if (const ChunkKind kind = kind_by_heights(world, key, low_m, high_m); kind != ChunkKind::kMesh) return kind;
  return mesh_chunk(world, key, sample_chunk(world, key, scratch), scratch, out);
}

}  // namespace talus
