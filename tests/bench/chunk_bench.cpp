// A fresh surface chunk, stage by stage: `build/bench/bin/talus_bench --benchmark_filter=Chunk`.
#include <benchmark/benchmark.h>

#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"
#include "tests/bench/allocations.hpp"
#include "tests/bench/surface_chunks.hpp"

namespace talus::bench {
namespace {

constexpr int kChunks = 64;

/// What every stage starts from: the work of the stages before it, done once.
struct Prepared {
  ChunkKey key;
  ChunkScratch scratch;
  DensityBox box;
  ChunkMesh mesh;
};

struct Stage {
  WorldFunction world{Manifest()};
  std::vector<Prepared> chunks;
  Stage() {
    for (const ChunkKey& key : surface_chunks(world, 0, kChunks)) {
      Prepared p{key, {}, {}, {}};
      world.columns(chunk_columns(world, key), p.scratch.columns);
      world.volume(p.scratch.columns, p.scratch.volume);
      p.box = sample_chunk(world, key, p.scratch);
      if (mesh_chunk(world, key, p.box, p.scratch, p.mesh) == ChunkKind::kMesh) chunks.push_back(std::move(p));
    }
  }
};

Stage& stage() {
  static Stage prepared;
  return prepared;
}

/// Times body(chunk) over all prepared chunks in turn and counts allocations.
template <class Body>
void run(benchmark::State& state, Body body) {
  Stage& s = stage();
  for (Prepared& p : s.chunks) body(s, p);
  std::size_t next = 0;
  const std::uint64_t before = allocations();
  for (auto _ : state) {
    body(s, s.chunks[next]);
    next = (next + 1) % s.chunks.size();
  }
  state.counters["allocations"] =
      benchmark::Counter(static_cast<double>(allocations() - before), benchmark::Counter::kAvgIterations);
}

void ChunkColumns(benchmark::State& state) {
  run(state, [](Stage& s, Prepared& p) { s.world.columns(chunk_columns(s.world, p.key), p.scratch.columns); });
}
void ChunkVolume(benchmark::State& state) {
  run(state, [](Stage& s, Prepared& p) { s.world.volume(p.scratch.columns, p.scratch.volume); });
}
void ChunkDensity(benchmark::State& state) {
  run(state, [](Stage& s, Prepared& p) { p.box = sample_chunk(s.world, p.key, p.scratch); });
}
void ChunkExtraction(benchmark::State& state) {
  run(state, [](Stage& s, Prepared& p) { mesh_chunk(s.world, p.key, p.box, p.scratch, p.mesh); });
}
void ChunkEncoding(benchmark::State& state) {
  std::size_t bytes = 0;
  std::size_t triangles = 0;
  run(state, [&](Stage& s, Prepared& p) {
    const auto encoded =
        protocol::encode_draco(p.mesh, protocol::mesh_lattice(p.key, s.world.cells(), s.world.voxel_m()));
    bytes += encoded->size();
    triangles += p.mesh.triangles();
  });
  state.counters["bytes/triangle"] = static_cast<double>(bytes) / static_cast<double>(triangles);
  state.counters["triangles"] = static_cast<double>(stage().chunks[0].mesh.triangles());
}
void ChunkFromKeyToBytes(benchmark::State& state) {
  ChunkScratch scratch;
  ChunkMesh mesh;
  run(state, [&](Stage& s, Prepared& p) {
    build_chunk(s.world, p.key, scratch, mesh);
    benchmark::DoNotOptimize(
        protocol::encode_draco(mesh, protocol::mesh_lattice(p.key, s.world.cells(), s.world.voxel_m())));
  });
}
void ChunkRuledOut(benchmark::State& state) {
  const WorldFunction& world = stage().world;
  ChunkScratch scratch;
  ChunkMesh mesh;
  std::int32_t x = 0;
  for (auto _ : state) benchmark::DoNotOptimize(build_chunk(world, {0, x++, 1000, 0}, scratch, mesh));
}

BENCHMARK(ChunkColumns)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkVolume)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkDensity)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkExtraction)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkEncoding)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkFromKeyToBytes)->Unit(benchmark::kMicrosecond);
BENCHMARK(ChunkRuledOut)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace talus::bench

BENCHMARK_MAIN();
