#include "tests/bench/meshes/strip_table.hpp"

#include <cstdio>
#include <map>
#include <set>

#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/meshopt_codec.hpp"
#include "tests/bench/meshes/cpu_time.hpp"

namespace talus::bench {
namespace {

struct Row {
  std::size_t meshes = 0, triangles = 0, draco_bytes = 0, meshopt_bytes = 0;
  CpuTime cold, known, draco, meshopt;

  void add_payloads(const ChunkMesh& mesh, const protocol::MeshLattice& lattice) {
    ++meshes;
    triangles += mesh.triangles();
    draco.start();
    draco_bytes += protocol::encode_draco(mesh, lattice)->size();
    draco.stop();
    meshopt.start();
    meshopt_bytes += protocol::encode_meshopt(mesh, lattice)->size();
    meshopt.stop();
  }

  void print(const char* name) const {
    if (meshes == 0) return;
    const auto mean = [&](double sum) { return sum / static_cast<double>(meshes); };
    std::printf("  %-22s %6zu %10.0f %10.0f %10.0f %8.0f %8.0f %8.0f %8.0f\n", name, meshes, mean(cold.seconds() * 1e6),
                mean(known.seconds() * 1e6), mean(static_cast<double>(triangles)),
                mean(static_cast<double>(draco_bytes)), mean(draco.seconds() * 1e6),
                mean(static_cast<double>(meshopt_bytes)), mean(meshopt.seconds() * 1e6));
  }
};

}  // namespace

void print_strips(const WorldFunction& world, const TerrainSample& view) {
  Row chunks;
  Row upright;
  Row level;
  ChunkScratch scratch;
  StripScratch strip_scratch;
  ChunkMesh mesh;
  std::map<ChunkKey, ColumnBlock> known;
  const ColumnLoader evaluate = [&](const ChunkKey& key, ColumnBlock& out) {
    world.columns(chunk_columns(world, key), out);
    world.volume(out, strip_scratch.volume);
  };
  const ColumnLoader remember = [&](const ChunkKey& key, ColumnBlock& out) {
    const auto [at, is_new] = known.try_emplace({key.lod, key.x, 0, key.z});
    if (is_new) evaluate(key, at->second);
    out = at->second;
  };
  std::set<ChunkKey> seen;
  for (const StripKey& strip : view.strips) {
    if (seen.insert(strip.key).second) {
      chunks.cold.start();
      const ChunkKind kind = build_chunk(world, strip.key, scratch, mesh);
      chunks.cold.stop();
      if (kind == ChunkKind::kMesh) {
        chunks.add_payloads(mesh, protocol::mesh_lattice(strip.key, world.cells(), world.voxel_m()));
      }
    }
    Row& row = strip.face == ChunkFace::kPy || strip.face == ChunkFace::kNy ? level : upright;
    row.cold.start();
    build_strip(world, strip.key, strip.face, evaluate, strip_scratch, mesh);
    row.cold.stop();
    build_strip(world, strip.key, strip.face, remember, strip_scratch, mesh);  // so that its columns are known
    row.known.start();
    build_strip(world, strip.key, strip.face, remember, strip_scratch, mesh);
    row.known.stop();
    row.add_payloads(mesh, protocol::strip_lattice(strip.key, world.cells(), world.voxel_m()));
  }
  std::printf("%s: its strips, means of one\n  %-22s %6s %10s %10s %10s %8s %8s %8s %8s\n", view.name.c_str(), "", "",
              "us to make", "col. known", "triangles", "Draco B", "us", "mesh B", "us");
  chunks.print("chunks that have them");
  upright.print("strips, upright face");
  level.print("strips, level face");
}

}  // namespace talus::bench
