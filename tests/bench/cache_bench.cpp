// Hit ratios of the memory cache against an order of last use, and what a hit costs:
// `build/bench/bin/talus_bench --benchmark_filter=Cache`.
#include <benchmark/benchmark.h>

#include "tests/support/cache_traces.hpp"

namespace talus::bench {
namespace {

using talus::test::flight;
using talus::test::hot_hit_ratio;
using talus::test::interleaved;
using talus::test::LruCache;
using talus::test::OurCache;
using talus::test::Trace;

void ratios(benchmark::State& state, const Trace& trace) {
  const auto bytes_max = static_cast<std::size_t>(state.range(0)) << 20;
  for (auto _ : state) {
    state.counters["ours"] = hot_hit_ratio<OurCache>(trace, bytes_max);
    state.counters["lru"] = hot_hit_ratio<LruCache>(trace, bytes_max);
    state.counters["requests"] = static_cast<double>(trace.size());
  }
}

void CacheVisits(benchmark::State& state) {
  ratios(state, interleaved(talus::test::visits(8, 12), 0));
}
void CacheVisitsScanned(benchmark::State& state) {
  ratios(state, interleaved(talus::test::visits(8, 12), static_cast<int>(state.range(1))));
}
/// One viewer on a circle, round and round: the worst case of an order of last use when the circle does not fit.
void CacheCircle(benchmark::State& state) {
  ratios(state, flight({0.0, 40.0, 1200.0}, 800, 1000));
}
BENCHMARK(CacheVisits)->Arg(4)->Arg(12)->Arg(48)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(CacheVisitsScanned)
    ->Args({12, 8})
    ->Args({12, 40})
    ->Args({48, 40})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(CacheCircle)->Arg(4)->Arg(12)->Arg(48)->Iterations(1)->Unit(benchmark::kMillisecond);

void CacheHit(benchmark::State& state) {
  server::MemoryCache cache(std::size_t{64} << 20);
  const Trace trace = flight({0.0, 8.0, 0.0}, 4, 1000);
  std::vector<server::PayloadName> names(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    names[i].key = trace[i].key;
    cache.store(names[i], std::make_shared<const server::ChunkPayload>());
  }
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(cache.load(names[i = (i + 1) % names.size()]));
}
BENCHMARK(CacheHit);

}  // namespace
}  // namespace talus::bench
