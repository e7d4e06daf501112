// What a client decodes of any view is one watertight surface: every edge is shared by exactly two triangles, but for
// the outer hull of the view. Positions are compared bit for bit.
//
// 200 views take some ten seconds; TALUS_SEAM_VIEWS=10000 is the long run.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <unordered_set>

#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/interest_area.hpp"
#include "protocol/mesh_codec.hpp"
#include "tests/support/assembly.hpp"
#include "tests/support/random.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSeed = 2004;

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

  /// Empty for air and rock.
  ChunkMesh chunk(const ChunkKey& key) {
    const glm::dvec2 range = world_.height_range_m();
    if (kind_by_heights(world_, key, range.x, range.y) != ChunkKind::kMesh) return {};
    load(key, scratch_.columns);
    const auto low_m = static_cast<double>(scratch_.columns.height_low_m);
    const auto high_m = static_cast<double>(scratch_.columns.height_high_m);
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
    if (known.stride == 0) world_.columns(chunk_columns(world_, key), known);
    out = known;
  }

  static ChunkMesh over_the_wire(const ChunkMesh& mesh, const protocol::MeshLattice& lattice) {
    const auto bytes = protocol::encode_draco(mesh, lattice);
    EXPECT_TRUE(bytes.has_value());
    auto decoded = protocol::decode_draco(bytes.value(), lattice);
    EXPECT_TRUE(decoded.has_value());
    return decoded ? std::move(*decoded) : ChunkMesh{};
  }

  const WorldFunction& world_;
  ChunkScratch scratch_;
  StripScratch strip_scratch_;
  std::map<ChunkKey, ColumnBlock> columns_;
};

double height_at(const WorldFunction& world, double x, double z) {
  ColumnBlock block;
  world.columns({static_cast<std::int64_t>(x), static_cast<std::int64_t>(z), 1, 1, 1, world.voxel_m()}, block);
  return static_cast<double>(block.height_m[0]);
}

/// A view close to the ground: in the mountains, at sea level or anywhere, at the origin or at 10^9 m.
protocol::View random_view(const WorldFunction& world, testing::Random& random, int number) {
  const double reach_m = number % 2 == 0 ? 2.0e4 : 1.0e9;
  protocol::View view;
  double best = -1.0e9;
  for (int i = 0; i < 12; ++i) {
    const double x = std::floor(random.real(-reach_m, reach_m));
    const double z = std::floor(random.real(-reach_m, reach_m));
    const double height_m = height_at(world, x, z);
    const double merit = number % 3 == 0 ? height_m : number % 3 == 1 ? -std::abs(height_m) : 0.0;
    if (merit <= best) continue;
    best = merit;
    view.position = {x + random.unit(), height_m + random.real(-25.0, 60.0), z + random.unit()};
  }
  view.near_m = 56.0;
  view.far_m = random.real(90.0, 190.0);
  return view;
}

struct Totals {
  std::size_t meshes = 0;
  std::size_t strips = 0;
  std::size_t edges = 0;
  std::array<int, kLodMax + 1> lods{};
};

/// Every strip that a view needs: between a leaf and a finer one whose surface reaches the face between them.
std::vector<StripKey> strips_of(const std::vector<ChunkKey>& leaves, const std::map<ChunkKey, unsigned>& faces) {
  const std::unordered_set<ChunkKey, ChunkKeyHash> area(leaves.begin(), leaves.end());
  std::map<StripKey, int> out;
  for (const auto& [key, reached] : faces) {
    for (const ChunkFace face : kAllChunkFaces) {
      const ChunkKey across = parent_of(neighbour_of(key, face));
      if ((reached & bit_of(face)) != 0 && area.contains(across)) ++out[{across, opposite(face)}];
    }
  }
  std::vector<StripKey> keys;
  for (const auto& [strip, uses] : out) keys.push_back(strip);
  return keys;
}

void expect_watertight(Wire& wire, const protocol::View& view, const protocol::WorldShape& shape, Totals& totals) {
  std::vector<ChunkKey> leaves;
  protocol::interest_area(protocol::clamped(view, shape), shape, leaves);
  testing::Assembly assembly(shape.cells);
  std::map<ChunkKey, unsigned> faces;
  wire.forget();
  for (const ChunkKey& key : leaves) {
    assembly.add_place(key);
    const ChunkMesh mesh = wire.chunk(key);
    if (mesh.indices.empty()) continue;
    assembly.add_mesh(key, mesh);
    faces[key] = faces_reached(mesh, shape.cells);
    ++totals.meshes;
    ++totals.lods[static_cast<std::size_t>(key.lod)];
  }
  for (const StripKey& strip : strips_of(leaves, faces)) {
    assembly.add_strip(strip, wire.strip(strip));
    ++totals.strips;
  }
  const auto open = assembly.open_edges();
  totals.edges += assembly.edges();
  ASSERT_TRUE(open.empty()) << open.size() << " edges are open, the first from and to " << testing::text_of(open[0])
                            << "(steps of LOD 0); the view stands at " << view.position.x << ' ' << view.position.y
                            << ' ' << view.position.z << ", far " << view.far_m;
}

TEST(Watertight, EveryEdgeOfARandomViewIsSharedByExactlyTwoTriangles) {
  const char* asked = std::getenv("TALUS_SEAM_VIEWS");
  const int views = asked == nullptr ? 200 : std::atoi(asked);
  const WorldFunction world{small_chunks()};
  const protocol::WorldShape shape{world.cells(), world.voxel_m(), world.height_range_m()};
  testing::Random random(kSeed);
  Wire wire(world);
  Totals totals;
  for (int number = 0; number < views; ++number) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", view " << number);
    expect_watertight(wire, random_view(world, random, number), shape, totals);
    if (HasFatalFailure()) return;
  }
  std::printf("%d views: %zu meshes, %zu strips, %zu edges closed\n", views, totals.meshes, totals.strips,
              totals.edges / 2);
  EXPECT_GT(totals.strips, static_cast<std::size_t>(10 * views)) << "too few strips were needed";
  for (const std::size_t lod : {0U, 1U, 2U}) EXPECT_GT(totals.lods[lod], views) << "LOD " << lod;
}

}  // namespace
}  // namespace talus
