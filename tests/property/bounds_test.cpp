// What bounds say of a box is never wrong: no rock where they say air, no air where they say rock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/mesh/build_chunk.hpp"
#include "core/world/density.hpp"
#include "tests/support/random.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

/// TALUS_BOUND_BOXES=10000000 is the long run; TALUS_BOUND_SEED another piece of the world.
std::int64_t asked(const char* name, std::int64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

/// A third of the worlds has more of everything that could reach beyond a bound.
Manifest manifest_of(int n) {
  Manifest manifest;
  manifest.seed += static_cast<std::uint64_t>(n);
  const auto set = [&](const char* name, double value) { manifest.values[parameter_index(name)] = value; };
  if (n % 3 == 1) {
    set("warp.reach_m", 6);
    set("carve.roughness_m", 2);
    set("carve.union_m", 4);
    set("carve.blend_m", 4);
    set("alcoves.fall", 0.5);
    set("caves.fall", 0.5);
    set("coast.cliff_m", 90);
    set("coast.cliff_slope", 0.01);
  }
  return manifest;
}

constexpr int kBoxesPerChunk = 250;
/// Samples above and below what can be surface, where bounds are asked as well.
constexpr int kAround = 3;

/// All densities of the columns of one chunk, and what the bounds say of them.
class Stack {
 public:
  Stack(const WorldFunction& world, const ChunkKey& key) {
    world.columns(chunk_columns(world, key), columns_);
    world.volume(columns_, volume_);
    row_spans(world, columns_, spans_);
    const ColumnGrid& grid = columns_.grid;
    step_m_ = static_cast<double>(grid.step_voxel) * grid.voxel_m;
    const auto layer = [&](float height_m) {
      return static_cast<std::int64_t>(std::floor(static_cast<double>(height_m) / step_m_));
    };
    const std::int64_t low = layer(columns_.rock_below_m) - kAround;
    // Tall stacks of fine cells are looked at around their foot or their top.
    constexpr std::int64_t kLayersMax = 320;
    const std::int64_t high = std::min(layer(columns_.air_above_m) + kAround, low + kLayersMax);
    layers_ = static_cast<int>(high - low) + 1;
    samples_.resize(density_floats(grid, layers_));
    box_ = sample_density(world, columns_, low * grid.step_voxel, layers_, {}, volume_, samples_);
  }

  int layers() const { return layers_; }
  bool is_carved() const { return !columns_.spheres.empty(); }

  /// A box of samples: rows of columns k0..k1, columns i0..i1, layers j0..j1, ends included.
  struct Box {
    int i0, i1, j0, j1, k0, k1;
  };

  /// What the heights of its rows say of a box.
  ChunkKind told(const Box& b) const {
    float low_m = spans_[static_cast<std::size_t>(b.k0)].low_m;
    float high_m = spans_[static_cast<std::size_t>(b.k0)].high_m;
    for (int k = b.k0; k <= b.k1; ++k) {
      low_m = std::min(low_m, spans_[static_cast<std::size_t>(k)].low_m);
      high_m = std::max(high_m, spans_[static_cast<std::size_t>(k)].high_m);
    }
    return kind(b, low_m, high_m);
  }
  /// What those of the whole chunk say.
  ChunkKind told_at_large(const Box& b) const { return kind(b, columns_.rock_below_m, columns_.air_above_m); }

  /// Whether every sample of the box is what was told: air is 0 or more, rock below 0.
  bool is(ChunkKind said, const Box& b) const {
    for (int j = b.j0; j <= b.j1; ++j) {
      for (int k = b.k0; k <= b.k1; ++k) {
        const float* row =
            &samples_[(static_cast<std::size_t>(j) * box_.depth + static_cast<std::size_t>(k)) * box_.stride];
        const auto [low, high] = std::minmax_element(row + b.i0, row + b.i1 + 1);
        if (said == ChunkKind::kAir ? *low < 0.0f : *high >= 0.0f) return false;
      }
    }
    return true;
  }

 private:
  double y_m(int layer) const { return static_cast<double>(box_.y_voxel) * columns_.grid.voxel_m + layer * step_m_; }
  ChunkKind kind(const Box& b, float low_m, float high_m) const {
    if (static_cast<double>(high_m) <= y_m(b.j0)) return ChunkKind::kAir;
    if (static_cast<double>(low_m) > y_m(b.j1)) return ChunkKind::kRock;
    return ChunkKind::kMesh;
  }

  ColumnBlock columns_;
  VolumeScratch volume_;
  std::vector<HeightSpan> spans_;
  std::vector<float> samples_;
  DensityBox box_;
  double step_m_ = 1;
  int layers_ = 0;
};

/// Most boxes are small; one in eight may be as large as the stack.
Stack::Box random_box(test::Random& random, const Stack& stack, int columns) {
  const auto interval = [&](int count, int& low, int& high) {
    const std::int64_t most = random.whole(0, 7) == 0 ? count - 1 : std::min(count - 1, 8);
    const std::int64_t length = random.whole(0, most);
    low = static_cast<int>(random.whole(0, count - 1 - length));
    high = low + static_cast<int>(length);
  };
  Stack::Box box{};
  interval(columns, box.i0, box.i1);
  interval(stack.layers(), box.j0, box.j1);
  interval(columns, box.k0, box.k1);
  return box;
}

TEST(Bounds, AreNeverWrong) {
  const std::int64_t boxes = asked("TALUS_BOUND_BOXES", 100'000);
  const auto seed = static_cast<std::uint64_t>(asked("TALUS_BOUND_SEED", 41));
  test::Random random(seed);
  std::int64_t air = 0;
  std::int64_t rock = 0;
  std::int64_t carved = 0;
  std::int64_t at = 0;
  for (int n = 0; at < boxes; ++n) {
    const WorldFunction world{manifest_of(n)};
    const glm::dvec2 range = world.height_range_m();
    for (int chunk = 0; chunk < 130 && at < boxes; ++chunk) {
      const int lod = chunk % 2 == 0 ? 0 : static_cast<int>(random.whole(0, kLodMax));
      const ChunkKey key = test::random_surface_key(world, random, lod);
      const Stack stack(world, key);
      ASSERT_LE(range.x, range.y);
      carved += stack.is_carved() ? 1 : 0;
      for (int k = 0; k < kBoxesPerChunk && at < boxes; ++k, ++at) {
        const Stack::Box box = random_box(random, stack, world.cells() + 3);
        for (const ChunkKind said : {stack.told(box), stack.told_at_large(box)}) {
          if (said == ChunkKind::kMesh) continue;
          ++(said == ChunkKind::kAir ? air : rock);
          ASSERT_TRUE(stack.is(said, box)) << "seed " << seed << ", world " << n << ", lod " << key.lod << ", chunk "
                                           << key.x << ' ' << key.y << ' ' << key.z << ", box " << at;
        }
      }
    }
  }
  EXPECT_GT(air, boxes / 20) << "the bounds said too little to be tested";
  EXPECT_GT(rock, boxes / 20);
  EXPECT_GT(carved, boxes / kBoxesPerChunk / 100) << "too few chunks had caves";
}

}  // namespace
}  // namespace talus
