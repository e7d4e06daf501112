// Field kernels by the point, SIMD against plain scalar: `build/bench/bin/talus_bench --benchmark_filter=Field`.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/erosion/filter.hpp"
#include "core/landforms/coast.hpp"
#include "core/landforms/cones.hpp"
#include "core/landforms/detail.hpp"
#include "core/noise/gradient_noise.hpp"
#include "core/plates/macro_field.hpp"
#include "core/strata/layer_search.hpp"
#include "core/world/world_function.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/unit/erosion/filter_reference.hpp"

namespace talus::bench {
namespace {

constexpr ColumnGrid kTile{120'000, 340'000, 1, 64, 64, 1.0};
constexpr double kPoints = 64.0 * 64.0;

void count_points(benchmark::State& state, double points) {
  state.counters["s/point"] =
      benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct ErosionArrays {
  std::vector<float> slope_x, slope_z, fade, strength, height, out_x, out_z, ridge;
  ErosionArrays() {
    for (auto* a : {&slope_x, &slope_z, &fade, &strength, &height, &out_x, &out_z, &ridge})
      a->resize(sample_count(kTile));
    for (std::size_t n = 0; n < slope_x.size(); ++n) {
      const auto t = static_cast<float>(n);
      slope_x[n] = 0.4f * std::sin(t * 0.01f);
      slope_z[n] = 0.4f * std::cos(t * 0.003f);
      fade[n] = std::sin(t * 0.002f);
      strength[n] = 0.9f;
    }
  }
};

void FieldErosion(benchmark::State& state) {
  ErosionArrays a;
  ErosionControls controls;
  controls.octaves = static_cast<int>(state.range(0));
  for (auto _ : state) {
    erode(controls, kTile, {a.slope_x, a.slope_z, a.fade, a.strength}, {a.height, a.out_x, a.out_z, a.ridge});
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// One point at a time, double precision and libm: the in-tree reference.
void FieldErosionScalar(benchmark::State& state) {
  const ErosionArrays a;
  ErosionControls controls;
  controls.octaves = static_cast<int>(state.range(0));
  for (auto _ : state) {
    for (int k = 0; k < 64; k += 4) {
      for (int i = 0; i < 64; ++i) {
        const auto n = static_cast<std::size_t>(k * 64 + i);
        benchmark::DoNotOptimize(test::erode_reference(
            controls, static_cast<double>(kTile.x_voxel + i), static_cast<double>(kTile.z_voxel + k),
            static_cast<double>(a.slope_x[n]), static_cast<double>(a.slope_z[n]), static_cast<double>(a.fade[n]), 0.9));
      }
    }
  }
  count_points(state, kPoints / 4);
}

void FieldNoise(benchmark::State& state) {
  std::vector<float> v(sample_count(kTile));
  std::vector<float> x(v.size());
  std::vector<float> z(v.size());
  const FractalNoise noise{900, static_cast<int>(state.range(0)), 2.03, 0.5, 1};
  for (auto _ : state) {
    fractal_noise(noise, kTile, v, x, z);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// A shore that rises by 0.16 through the middle of the tile: everything the stage can be asked for.
void FieldCoast(benchmark::State& state) {
  const std::size_t count = sample_count(kTile);
  const std::vector<float> rise(count, 0.16f);
  const std::vector<float> level(count, 0.0f);
  const std::vector<float> hilliness(count, 0.5f);
  std::vector<float> height(count);
  std::vector<float> slope_x(count);
  std::vector<float> slope_z(count);
  std::vector<float> cliff(count);
  std::vector<float> beach(count);
  std::vector<float> workspace(count * kCoastArrays);
  for (auto _ : state) {
    for (std::size_t n = 0; n < count; ++n) height[n] = 0.16f * static_cast<float>(n % row_stride(kTile)) - 5.0f;
    coast({}, kTile, {rise, level, hilliness}, {height, slope_x, slope_z, cliff, beach}, workspace);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// A tile on the flank of a volcano.
void FieldCones(benchmark::State& state) {
  const std::size_t count = sample_count(kTile);
  std::array<std::vector<float>, 6> relief;
  for (auto& array : relief) array.resize(count);
  std::vector<float> workspace(count * kConeArrays);
  const Cone volcano{static_cast<double>(kTile.x_voxel) - 500,
                     static_cast<double>(kTile.z_voxel),
                     2400,
                     800,
                     0.1f,
                     70,
                     1,
                     0.6f,
                     false};
  for (auto _ : state) {
    raise_cones({}, {&volcano, 1}, kTile, {relief[0], relief[1], relief[2]}, {relief[3], relief[4], relief[5]},
                workspace);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// A tile of scree.
void FieldDetail(benchmark::State& state) {
  const std::size_t count = sample_count(kTile);
  const std::vector<float> hilliness(count, 0.6f);
  const std::vector<float> none(count, 0.0f);
  std::vector<float> height(count, 300.0f);
  std::vector<float> slope_x(count);
  std::vector<float> slope_z(count);
  std::vector<float> workspace(count * kDetailArrays);
  for (auto _ : state) {
    std::fill(slope_x.begin(), slope_x.end(), 0.7f);
    std::fill(slope_z.begin(), slope_z.end(), 0.0f);
    add_detail({}, kTile, {hilliness, none, none, none}, {height, slope_x, slope_z}, workspace);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

void FieldColumnsTile(benchmark::State& state) {
  const WorldFunction world{Manifest()};
  ColumnBlock block;
  for (auto _ : state) {
    world.columns(kTile, block);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// The macro field alone: over a LOD 0 tile (by the column), and where every column is a node (by the node).
void FieldMacro(benchmark::State& state) {
  const MacroField field(PlateControls{}, MacroControls{});
  ColumnGrid grid = kTile;
  grid.x_voxel = 122'880;
  grid.z_voxel = 344'064;
  grid.step_voxel = state.range(0);
  std::vector<float> arrays(8 * sample_count(grid));
  const auto part = [&](std::size_t n) { return arrays.data() + n * sample_count(grid); };
  const MacroArrays out{part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7)};
  MacroScratch scratch;
  for (auto _ : state) {
    field.sample(grid, scratch, out);
    benchmark::ClobberMemory();
  }
  count_points(state, kPoints);
}

/// A plate from nothing: its polygon, its neighbours' traits, its faults' curves.
void FieldPlate(benchmark::State& state) {
  const PlateBuilder builder(PlateControls{}, MacroControls{});
  std::vector<Site> sites;
  for (std::int64_t n = 0; n < 16; ++n) builder.sites().add_sites(n, 2 * n, sites);
  Plate plate;
  std::size_t next = 0;
  for (auto _ : state) builder.build(sites[next++ % sites.size()].key, plate);
}

/// The layers of 97x97 points anywhere in a stack of 2048.
void FieldLayers(benchmark::State& state) {
  const LayerSearch search{LayerSet(1)};
  std::vector<float> depths_m(97 * 97);
  for (std::size_t n = 0; n < depths_m.size(); ++n) {
    const auto spread = static_cast<float>(n * 7919 % depths_m.size()) / static_cast<float>(depths_m.size());
    depths_m[n] = spread * kStackDepth;
  }
  std::vector<std::int32_t> layers(depths_m.size());
  for (auto _ : state) {
    search.find(depths_m, layers);
    benchmark::ClobberMemory();
  }
  count_points(state, static_cast<double>(depths_m.size()));
}

BENCHMARK(FieldMacro)->Arg(1)->Arg(32)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldPlate)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldErosion)->Arg(5)->Arg(7)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldErosionScalar)->Arg(5)->Arg(7)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldNoise)->Arg(1)->Arg(5)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldCoast)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldDetail)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldCones)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldColumnsTile)->Unit(benchmark::kMicrosecond);
BENCHMARK(FieldLayers)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace talus::bench
