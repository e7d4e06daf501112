// What one view message costs the network thread: `build/bench/bin/talus_bench --benchmark_filter=Viewer`.
#include <benchmark/benchmark.h>

#include "server/world/viewer.hpp"

namespace talus::bench {
namespace {

constexpr protocol::WorldShape kShape{};
constexpr unsigned kUpright =
    bit_of(ChunkFace::kPx) | bit_of(ChunkFace::kNx) | bit_of(ChunkFace::kPz) | bit_of(ChunkFace::kNz);

unsigned faces_of(const ChunkKey& key) {
  const BoxWorld box = box_of(key, kShape.cells, kShape.voxel_m);
  return box.low.y <= 100 && 100 < box.high.y ? kUpright : 0;
}

protocol::ViewMessage view_at(double way_m, double far_m) {
  protocol::ViewMessage message;
  message.view.position = {way_m, 120.0, 0.0};
  message.view.velocity = {20.0, 0.0, 0.0};
  message.view.direction = {1.0, 0.0, 0.0};
  message.view.far_m = far_m;
  return message;
}

/// In flight at 20 m/s, a message every tenth of a second; everything wanted comes at once, so that all but a few
/// chunks are held. The ground is level at 100 m, so what it crosses has a surface that reaches the four upright faces.
void ViewerInFlight(benchmark::State& state) {
  server::Viewer viewer(kShape, std::uint64_t{1} << 48, true);
  double way_m = 0;
  std::size_t sent = 0;
  for (auto _ : state) {
    viewer.on_message(view_at(way_m, static_cast<double>(state.range(0))));
    benchmark::DoNotOptimize(viewer.refresh());
    state.PauseTiming();
    for (auto next = viewer.next_request(); next; next = viewer.next_request()) {
      viewer.deliver(next->piece, 1000, faces_of(next->piece.key));
      ++sent;
    }
    way_m += 2.0;
    state.ResumeTiming();
  }
  state.counters["sent"] = static_cast<double>(sent) / static_cast<double>(state.iterations());
}
BENCHMARK(ViewerInFlight)->Arg(2000)->Arg(12000)->Unit(benchmark::kMicrosecond);

/// The same on a server that is slow: nothing has come yet.
void ViewerWaiting(benchmark::State& state) {
  server::Viewer viewer(kShape, std::uint64_t{1} << 48, true);
  double way_m = 0;
  for (auto _ : state) {
    viewer.on_message(view_at(way_m, static_cast<double>(state.range(0))));
    benchmark::DoNotOptimize(viewer.refresh());
    way_m += 2.0;
  }
}
BENCHMARK(ViewerWaiting)->Arg(2000)->Arg(12000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace talus::bench
