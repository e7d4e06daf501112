#include "core/mesh/seam_strip.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/check.hpp"
#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_cell.hpp"
#include "core/mesh/vertex_maker.hpp"

namespace talus {
namespace {

/// Axes of a face: u x v points out of the chunk.
struct FaceFrame {
  explicit FaceFrame(ChunkFace face)
      : normal(axis_of(face)),
        u((normal + (is_high(face) ? 1 : 2)) % 3),
        v((normal + (is_high(face) ? 2 : 1)) % 3),
        is_upper(is_high(face)) {}

  glm::ivec3 at(int along_u, int along_v) const {
    glm::ivec3 out{};
    out[u] = along_u;
    out[v] = along_v;
    return out;
  }

  int normal;
  int u;
  int v;
  bool is_upper;
};

/// Samples of one lattice on a part of the face, near the surface and nowhere else; sample (0, 0, 0) is that part's
/// lowest corner.
class Section {
 public:
  /// `cells` is how many the part has along y: none for a level face, of which one layer and its neighbours count.
  Section(const WorldFunction& world, VolumeScratch& volume, StripScratch::Lattice& lattice, std::int64_t y_voxel,
          int cells)
      : layers_(lattice.layers),
        parts_(parts_of_row(lattice.columns.grid)),
        samples_(sample(world, volume, lattice, y_voxel, cells)),
        maker_(world, lattice.columns, samples_, y_voxel) {}
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

  bool is_rock(const glm::ivec3& at) const {
    const int part = (at.z + 1) * parts_ + (at.x + 1) / kPartSamples;
    const LayerInterval& layers = layers_[static_cast<std::size_t>(part)];
    if (at.y < layers.first) return true;
    return at.y < layers.first + layers.count && samples_.at(at.x, at.y, at.z) < 0.0f;
  }
  float density(const glm::ivec3& at) const { return samples_.at(at.x, at.y, at.z); }
  MeshVertex vertex(const glm::ivec3& from, int axis) const { return maker_({axis, from.x, from.y, from.z}); }

 private:
  static Samples sample(const WorldFunction& world, VolumeScratch& volume, StripScratch::Lattice& lattice,
                        std::int64_t y_voxel, int cells) {
    ColumnBlock& columns = lattice.columns;
    if (!columns.has_volume) world.volume(columns, volume);
    part_spans(world, columns, lattice.spans);
    const LayerInterval all = layers_near_surface(columns, lattice.spans, y_voxel, cells, lattice.layers);
    lattice.wanted = lattice.layers;
    for (LayerInterval& layers : lattice.wanted) layers.first -= all.first;
    const std::size_t floats = density_floats(columns.grid, all.count);
    lattice.density.resize(std::max(lattice.density.size(), floats));
    const std::int64_t first_voxel = y_voxel + all.first * columns.grid.step_voxel;
    return {sample_density(world, columns, first_voxel, all.count, lattice.wanted, volume, lattice.density),
            lattice.density.data(), all.first};
  }

  const std::vector<LayerInterval>& layers_;
  int parts_;
  Samples samples_;
  VertexMaker maker_;
};

/// Where a crossing of a transition cell begins, in samples of its own lattice from the cell's corner, and along which
/// of the face's axes it runs.
struct CrossingPlace {
  bool is_coarse = false;
  bool is_along_u = false;
  int u = 0;
  int v = 0;
};

constexpr std::array<CrossingPlace, kSeamCrossings> crossing_places() {
  std::array<CrossingPlace, kSeamCrossings> out{};
  for (int i = 0; i < 2; ++i) {
    out[static_cast<std::size_t>(i)] = {true, true, 0, i};
    out[static_cast<std::size_t>(2 + i)] = {true, false, i, 0};
    for (int k = 0; k < 3; ++k) {
      out[static_cast<std::size_t>(seam_cell::fine_along_u(i, k))] = {false, true, i, k};
      out[static_cast<std::size_t>(seam_cell::fine_along_v(k, i))] = {false, false, k, i};
    }
  }
  return out;
}
constexpr auto kCrossingPlaces = crossing_places();

class StripMaker {
 public:
  StripMaker(const WorldFunction& world, const ChunkKey& key, ChunkFace face, const ColumnLoader& columns,
             StripScratch& scratch, ChunkMesh& out)
      : world_(world),
        key_(key),
        face_(face),
        frame_(face),
        columns_(columns),
        cells_(world.cells()),
        corner_(corner_voxel(key, cells_)),
        scratch_(scratch),
        out_(out) {
    const auto samples = static_cast<std::size_t>(2 * cells_ + 1);
    scratch.rock.resize(samples * samples);
    scratch.vertex_of.assign(2 * samples * samples + 2 * static_cast<std::size_t>((cells_ + 1) * (cells_ + 1)), -1);
  }

  void make() {
    if (frame_.normal == 1) return level();
    load_upright(fine_step(), 2 * cells_, scratch_.fine.columns);
    const Section fine(world_, scratch_.volume, scratch_.fine, corner_.y, 2 * cells_);
    part(fine, {0, 0}, cells_);
  }

 private:
  std::int64_t fine_step() const { return std::int64_t{1} << (key_.lod - 1); }
  std::int64_t plane_voxel() const { return corner_[frame_.normal] + (frame_.is_upper ? 2 * cells_ * fine_step() : 0); }

  /// A level face cuts through whole blocks of columns: those of the four finer chunks below it, one after the other.
  void level() {
    const auto finer = finer_across(key_, face_);
    const ChunkKey first = children_of(key_)[0];
    for (const ChunkKey& child : finer) {
      columns_(child, scratch_.fine.columns);
      const Section fine(world_, scratch_.volume, scratch_.fine, plane_voxel(), 0);
      const glm::ivec3 place{child.x - first.x, 0, child.z - first.z};
      part(fine, glm::ivec2{place[frame_.u], place[frame_.v]} * (cells_ / 2), cells_ / 2);
    }
  }

  /// Columns under an upright face: a line of them, with a halo on every side.
  void load_upright(std::int64_t step, int cells, ColumnBlock& out) const {
    glm::i64vec3 corner = corner_;
    corner[frame_.normal] = plane_voxel();
    const bool is_across_x = frame_.normal == 0;
    const ColumnGrid grid{
        corner.x - step, corner.z - step, step, is_across_x ? 3 : cells + 3, is_across_x ? cells + 3 : 3,
        world_.voxel_m()};
    world_.columns(grid, out);
  }

  /// The coarse lattice is wanted for normals alone; most strips with a vertex want it.
  const Section& coarse() {
    if (coarse_) return *coarse_;
    if (frame_.normal == 1) {
      columns_(key_, scratch_.coarse.columns);
      return coarse_.emplace(world_, scratch_.volume, scratch_.coarse, plane_voxel(), 0);
    }
    load_upright(2 * fine_step(), cells_, scratch_.coarse.columns);
    return coarse_.emplace(world_, scratch_.volume, scratch_.coarse, corner_.y, cells_);
  }

  /// `cells` x `cells` coarse cells from `first` on; the section's corner is the first's.
  void part(const Section& fine, const glm::ivec2& first, int cells) {
    const int samples = 2 * cells + 1;
    std::uint8_t* rock = scratch_.rock.data();
    for (int v = 0; v < samples; ++v) {
      for (int u = 0; u < samples; ++u) rock[v * samples + u] = fine.is_rock(frame_.at(u, v)) ? 1 : 0;
    }
    for (int v = 0; v < cells; ++v) {
      for (int u = 0; u < cells; ++u) {
        const std::uint8_t* row = rock + 2 * v * samples + 2 * u;
        unsigned pattern = 0;
        for (int k = 0; k < 3; ++k, row += samples) {
          pattern |= static_cast<unsigned>(row[0] | row[1] << 1 | row[2] << 2) << (3 * k);
        }
        if (pattern != 0 && pattern != kSeamPatterns - 1) cell(fine, pattern, first, {u, v});
      }
    }
  }

  void cell(const Section& fine, unsigned pattern, const glm::ivec2& first, const glm::ivec2& cell) {
    std::array<glm::ivec2, kSeamCrossings> at{};
    for (std::size_t i = 0; i < kSeamCrossings; ++i) {
      const CrossingPlace& place = kCrossingPlaces[i];
      const int scale = place.is_coarse ? 2 : 1;
      const glm::ivec2 from = glm::ivec2{place.u, place.v} * scale;
      const glm::ivec2 to = from + (place.is_along_u ? glm::ivec2{scale, 0} : glm::ivec2{0, scale});
      if (((pattern >> (from.x + 3 * from.y)) & 1U) == ((pattern >> (to.x + 3 * to.y)) & 1U)) continue;
      // A coarse sample is a fine one: its density is the same bits.
      const int step = scale * crossing_step(fine.density(frame_.at(2 * cell.x + from.x, 2 * cell.y + from.y)),
                                             fine.density(frame_.at(2 * cell.x + to.x, 2 * cell.y + to.y)));
      at[i] = from * kStepsPerCell + (place.is_along_u ? glm::ivec2{step, 0} : glm::ivec2{0, step});
    }
    const SeamTriangles triangles = seam_triangles(pattern, at);
    for (std::size_t i = 0; i < 3 * triangles.count; ++i) {
      out_.indices.push_back(vertex(fine, kCrossingPlaces[triangles.crossings[i]], first, cell));
    }
  }

  std::uint32_t vertex(const Section& fine, const CrossingPlace& place, const glm::ivec2& first,
                       const glm::ivec2& cell) {
    const int scale = place.is_coarse ? 1 : 2;
    const glm::ivec2 here = cell * scale + glm::ivec2{place.u, place.v};
    const glm::ivec2 on_face = first * scale + here;
    const int width = cells_ * scale + 1;
    const int fine_width = 2 * cells_ + 1;
    const int before = (place.is_coarse ? 2 * fine_width * fine_width : 0) + (place.is_along_u ? 0 : width * width);
    std::int32_t& known = scratch_.vertex_of[static_cast<std::size_t>(before + on_face.y * width + on_face.x)];
    if (known >= 0) return static_cast<std::uint32_t>(known);
    known = static_cast<std::int32_t>(out_.positions.size());

    const int axis = place.is_along_u ? frame_.u : frame_.v;
    MeshVertex made = place.is_coarse ? coarse().vertex(frame_.at(on_face.x, on_face.y), axis)
                                      : fine.vertex(frame_.at(here.x, here.y), axis);
    glm::ivec3 position = place.is_coarse ? 2 * glm::ivec3(made.position)
                                          : glm::ivec3(made.position) + 2 * kStepsPerCell * frame_.at(first.x, first.y);
    position[frame_.normal] = frame_.is_upper ? 2 * cells_ * kStepsPerCell : 0;
    out_.positions.emplace_back(position);
    out_.normals.push_back(made.normal);
    out_.materials.push_back(made.material);
    out_.ridges.push_back(made.ridge);
    return static_cast<std::uint32_t>(known);
  }

  const WorldFunction& world_;
  const ChunkKey key_;
  const ChunkFace face_;
  const FaceFrame frame_;
  const ColumnLoader& columns_;
  const int cells_;
  const glm::i64vec3 corner_;
  StripScratch& scratch_;
  ChunkMesh& out_;
  std::optional<Section> coarse_;
};

}  // namespace

void build_strip(const WorldFunction& world, const ChunkKey& key, ChunkFace face, const ColumnLoader& columns,
                 StripScratch& scratch, ChunkMesh& out) {
  TALUS_CHECK(is_valid(key) && key.lod > 0);
  out.clear();
  const glm::dvec2 range = world.height_range_m();
  if (kind_by_heights(world, key, range.x, range.y) != ChunkKind::kMesh) return;
  StripMaker(world, key, face, columns, scratch, out).make();
}

}  // namespace talus
