// What a client decodes of any view is one watertight surface: every edge is shared by exactly two triangles, but for
// the outer hull of the view. So is what it may draw while one view gives way to another. Positions are compared bit
// for bit.
//
// TALUS_SEAM_VIEWS=10000 is the long run; TALUS_SEAM_SEED makes another one of it, for another processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <unordered_set>

#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/interest_area.hpp"
#include "protocol/mesh_codec.hpp"
#include "protocol/meshopt_codec.hpp"
#include "tests/support/assembly.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_views.hpp"

namespace talus {
namespace {

std::uint64_t seed() {
  const char* asked = std::getenv("TALUS_SEAM_SEED");
  return asked == nullptr ? 2004 : std::strtoull(asked, nullptr, 10);
}

/// Small chunks make many faces out of little work.
Manifest small_chunks() {
  Manifest out;
  out.values[parameter_index("chunk.cells")] = 16;
  return out;
}

/// The world as its clients have it: bytes, decoded. Columns are remembered while one view is made.
class Wire {
 public:
  explicit Wire(const WorldFunction& world) : world_(world) {}

  void forget() { columns_.clear(); }

  /// Whether any sphere of that kind carves into what has been loaded of LOD 0.
  bool has(CarveKind kind) const {
    return std::ranges::any_of(columns_, [&](const auto& known) {
      const ColumnBlock& block = known.second;
      const auto is_inside = [&](double at_m, std::int64_t first, int count) {
        const double voxel = at_m / world_.voxel_m() - static_cast<double>(first);
        return voxel >= 0 && voxel < count;
      };
      return known.first.lod == 0 && std::ranges::any_of(block.spheres, [&](const CarveSphere& sphere) {
               return sphere.kind == kind && is_inside(sphere.x_m, block.grid.x_voxel, block.grid.width) &&
                      is_inside(sphere.z_m, block.grid.z_voxel, block.grid.depth);
             });
    });
  }
  bool has_shore() const {
    return std::ranges::any_of(columns_, [](const auto& known) {
      return known.first.lod == 0 && known.second.height_low_m < 0 && known.second.height_high_m > 0;
    });
  }

  /// Empty for air and rock.
  ChunkMesh chunk(const ChunkKey& key) {
    const glm::dvec2 range = world_.height_range_m();
    if (kind_by_heights(world_, key, range.x, range.y) != ChunkKind::kMesh) return {};
    load(key, scratch_.columns);
    const auto low_m = static_cast<double>(scratch_.columns.rock_below_m);
    const auto high_m = static_cast<double>(scratch_.columns.air_above_m);
    if (kind_by_heights(world_, key, low_m, high_m) != ChunkKind::kMesh) return {};
    ChunkMesh mesh;
    if (mesh_chunk(world_, key, sample_chunk(world_, key, scratch_), scratch_, mesh) != ChunkKind::kMesh) return {};
    return over_the_wire(mesh, protocol::mesh_lattice(key, world_.cells(), world_.voxel_m()));
  }

  ChunkMesh strip(const StripKey& strip) {
    ChunkMesh mesh;
    build_strip(
        world_, strip.key, strip.face, [&](const ChunkKey& key, ColumnBlock& out) { load(key, out); }, strip_scratch_,
        mesh);
    if (mesh.indices.empty()) return {};
    return over_the_wire(mesh, protocol::strip_lattice(strip.key, world_.cells(), world_.voxel_m()));
  }

 private:
  void load(const ChunkKey& key, ColumnBlock& out) {
    ColumnBlock& known = columns_[{key.lod, key.x, 0, key.z}];
    if (known.stride == 0) {
      world_.columns(chunk_columns(world_, key), known);
      world_.volume(known, scratch_.volume);
    }
    out = known;
  }

  ChunkMesh over_the_wire(const ChunkMesh& mesh, const protocol::MeshLattice& lattice) {
    // Either format, by turns.
    is_meshopt_ = !is_meshopt_;
    const auto bytes = is_meshopt_ ? protocol::encode_meshopt(mesh, lattice) : protocol::encode_draco(mesh, lattice);
    EXPECT_TRUE(bytes.has_value());
    auto decoded = protocol::decode_surface(bytes.value(), lattice);
    EXPECT_TRUE(decoded.has_value());
    return decoded ? std::move(*decoded) : ChunkMesh{};
  }

  const WorldFunction& world_;
  bool is_meshopt_ = false;
  ChunkScratch scratch_;
  StripScratch strip_scratch_;
  std::map<ChunkKey, ColumnBlock> columns_;
};

struct Totals {
  /// Views around the origin and around 10^9 m with anything of each kind of carving in them, and with the sea's level.
  std::array<std::array<int, kCarvePasses>, 2> carved{};
  std::array<int, 2> sea{};
  std::size_t meshes = 0;
  std::size_t strips = 0;
  std::size_t edges = 0;
  std::array<int, kLodMax + 1> lods{};
};

/// Chunks as a client has decoded them, each once.
class Decoded {
 public:
  Decoded(Wire& wire, int cells) : wire_(wire), cells_(cells) {}

  const ChunkMesh& mesh(const ChunkKey& key) {
    const auto [at, is_new] = meshes_.try_emplace(key);
    if (is_new) at->second = wire_.chunk(key);
    return at->second;
  }
  unsigned faces(const ChunkKey& key) { return faces_reached(mesh(key), cells_); }

 private:
  Wire& wire_;
  const int cells_;
  std::map<ChunkKey, ChunkMesh> meshes_;
};

using Area = std::unordered_set<ChunkKey, ChunkKeyHash>;

/// The chunk of `area` that holds `key`, itself or an ancestor.
std::optional<ChunkKey> holder_of(const Area& area, ChunkKey key) {
  for (; key.lod < kLodMax; key = parent_of(key)) {
    if (area.contains(key)) return key;
  }
  return std::nullopt;
}

/// Meshes of `drawn` with every strip between two of them whose LODs differ by one.
void expect_watertight(Wire& wire, Decoded& decoded, const std::vector<ChunkKey>& drawn, int cells,
                       std::size_t triangles_max, Totals& totals) {
  const Area area(drawn.begin(), drawn.end());
  test::Assembly assembly(cells);
  std::set<StripKey> strips;
  for (const ChunkKey& key : drawn) {
    assembly.add_place(key);
    const ChunkMesh& mesh = decoded.mesh(key);
    if (mesh.indices.empty()) continue;
    assembly.add_mesh(key, mesh);
    ++totals.meshes;
    ++totals.lods[static_cast<std::size_t>(key.lod)];
    for (const ChunkFace face : kAllChunkFaces) {
      const ChunkKey across = parent_of(neighbour_of(key, face));
      if ((decoded.faces(key) & bit_of(face)) != 0 && area.contains(across)) strips.insert({across, opposite(face)});
    }
  }
  for (const StripKey& strip : strips) assembly.add_strip(strip, wire.strip(strip));
  totals.strips += strips.size();
  const auto open = assembly.open_edges(triangles_max);
  totals.edges += assembly.edges();
  ASSERT_TRUE(open.empty()) << open.size() << " edges are open, the first from and to " << test::text_of(open[0])
                            << "(steps of LOD 0)";
}

/// What a client draws while the places of one view give way, in any order, to those of the next: SPEC.md 6.1.
std::vector<ChunkKey> between(Decoded& decoded, const std::vector<ChunkKey>& before, const std::vector<ChunkKey>& after,
                              test::Random& random) {
  const Area old_area(before.begin(), before.end());
  const Area new_area(after.begin(), after.end());
  // A place is named by the coarsest chunk that covers it in either view.
  const auto place_of = [&](const ChunkKey& key) {
    const ChunkKey in_old = holder_of(old_area, key).value_or(key);
    const ChunkKey in_new = holder_of(new_area, key).value_or(key);
    return in_old.lod > in_new.lod ? in_old : in_new;
  };
  std::map<ChunkKey, bool> is_made;
  const auto made = [&](const ChunkKey& key) -> bool& {
    return is_made.try_emplace(place_of(key), random.unit() < 0.5).first->second;
  };
  for (;;) {
    std::vector<ChunkKey> drawn;
    for (const ChunkKey& key : before) {
      if (!made(key)) drawn.push_back(key);
    }
    for (const ChunkKey& key : after) {
      if (made(key)) drawn.push_back(key);
    }
    const Area area(drawn.begin(), drawn.end());
    bool has_gap = false;
    for (const ChunkKey& key : drawn) {
      for (const ChunkFace face : kAllChunkFaces) {
        if ((decoded.faces(key) & bit_of(face)) == 0) continue;
        const auto across = holder_of(area, neighbour_of(key, face));
        if (!across || across->lod < key.lod + 2) continue;
        // Made both: in the end all are, and a view has no gap.
        has_gap = true;
        made(key) = true;
        made(*across) = true;
      }
    }
    if (!has_gap) return drawn;
  }
}

std::vector<ChunkKey> area_of(const protocol::View& view, const protocol::WorldShape& shape) {
  std::vector<ChunkKey> out;
  protocol::interest_area(protocol::clamped(view, shape), shape, out);
  return out;
}

int views_asked(int usual) {
  const char* asked = std::getenv("TALUS_SEAM_VIEWS");
  return asked == nullptr ? usual : std::atoi(asked);
}

class Watertight : public ::testing::Test {
 protected:
  /// Calls body(number, random, wire) for each of `views`, until one fails.
  template <class Body>
  void for_views(int views, Body body) {
    test::Random random(seed());
    test::RandomViews places(world_, random);
    Wire wire(world_);
    for (int number = 0; number < views; ++number) {
      const protocol::View view = places.view(number);
      SCOPED_TRACE(::testing::Message() << "seed " << seed() << ", view " << number << " from " << view.position.x
                                        << ' ' << view.position.y << ' ' << view.position.z << ", far " << view.far_m);
      wire.forget();
      body(view, random, wire);
      if (HasFatalFailure()) return;
      count_ground(wire, test::RandomViews::is_far(number) ? 1 : 0);
    }
    std::printf("%d views: %zu meshes, %zu strips, %zu edges closed\n", views, totals_.meshes, totals_.strips,
                totals_.edges / 2);
    for (const std::size_t far : {0U, 1U}) {
      const auto& [notches, caves, alcoves, arches] = totals_.carved[far];
      std::printf(
          "  around %s: %d with the sea's level, %d with notches, %d with caves, %d with alcoves, %d with arches\n",
          far == 0 ? "the origin" : "10^9 m", totals_.sea[far], notches, caves, alcoves, arches);
      EXPECT_GT(totals_.sea[far], views / 10);
      for (const int count : {notches, caves, alcoves}) EXPECT_GT(count, views / 40);
      EXPECT_GT(arches, 0);
    }
    EXPECT_GT(totals_.strips, static_cast<std::size_t>(5 * views)) << "too few strips were needed";
    for (const std::size_t lod : {0U, 1U, 2U}) EXPECT_GT(totals_.lods[lod], views / 4) << "LOD " << lod;
  }

  void count_ground(const Wire& wire, std::size_t far) {
    totals_.sea[far] += wire.has_shore() ? 1 : 0;
    for (std::size_t kind = 0; kind < kCarvePasses; ++kind) {
      totals_.carved[far][kind] += wire.has(static_cast<CarveKind>(kind)) ? 1 : 0;
    }
  }

  const WorldFunction world_{small_chunks()};
  const protocol::WorldShape shape_{world_.cells(), world_.voxel_m(), world_.height_range_m()};
  Totals totals_;
};

TEST_F(Watertight, EveryEdgeOfARandomViewIsSharedByExactlyTwoTriangles) {
  for_views(views_asked(200), [&](const protocol::View& view, test::Random&, Wire& wire) {
    Decoded decoded(wire, shape_.cells);
    expect_watertight(wire, decoded, area_of(view, shape_), shape_.cells, 2, totals_);
  });
}

TEST_F(Watertight, AndSoIsEverythingThatMayBeDrawnBetweenTwoViewsOfAFlight) {
  for_views(views_asked(80) / 2, [&](protocol::View view, test::Random& random, Wire& wire) {
    Decoded decoded(wire, shape_.cells);
    const std::vector<ChunkKey> before = area_of(view, shape_);
    const bool is_jump = random.unit() < 0.3;
    view.position.x += random.real(-1.0, 1.0) * (is_jump ? 90.0 : 30.0);
    view.position.z += random.real(-1.0, 1.0) * (is_jump ? 90.0 : 30.0);
    const std::vector<ChunkKey> after = area_of(view, shape_);
    for (int round = 0; round < 2; ++round) {
      const std::vector<ChunkKey> drawn = between(decoded, before, after, random);
      // Where two coarse and two fine places meet crosswise in an edge of a chunk, four strips meet there: closed, but
      // no view has that.
      expect_watertight(wire, decoded, drawn, shape_.cells, 4, totals_);
      if (HasFatalFailure()) return;
    }
  });
}

}  // namespace
}  // namespace talus
