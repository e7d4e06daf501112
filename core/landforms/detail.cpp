#include "core/landforms/detail.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/grid/axis.hpp"

#ifndef TALUS_DETAIL_ROW
#define TALUS_DETAIL_ROW
namespace talus {

/// Joints on a wall are as deep into it as they are on level rock up to this slope.
inline constexpr float kJointSlopeMax = 4.0f;

struct DetailNoise {
  const float *v, *x, *z;
};

struct DetailTerms {
  float rough_plain, rough_hill, joint, rock_slope;
  float boulder, block;  ///< metres of height per cell of either size
};

struct DetailRow {
  DetailNoise rough, joint_broad, joint_fine;
  const float *hilliness, *ridge, *cliff, *beach;
  float *height, *slope_x, *slope_z;
};

}  // namespace talus
#endif  // TALUS_DETAIL_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/detail.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/landforms/boulders-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE V rising(V v, float low, float high) {
  return smoothstep(low, high, Jet<V>{v, v, v}).v;
}

/// How much of each kind of ground there is at a lane, 0..1; they overlap.
template <class V>
struct GroundShares {
  V rock, scree, stones;
};

template <class D, class V = VecOf<D>>
HWY_INLINE GroundShares<V> shares_of(D d, const DetailTerms& t, const DetailRow& r, std::size_t i, V steep) {
  const V one = hn::Set(d, 1.0f);
  const V hilly = hn::LoadU(d, r.hilliness + i);
  const V height = hn::LoadU(d, r.height + i);
  const V beach = hn::LoadU(d, r.beach + i);
  GroundShares<V> s;
  s.rock = rising(steep, 0.75f * t.rock_slope, 1.3f * t.rock_slope);
  const V loose = hn::Mul(rising(steep, 0.42f * t.rock_slope, 0.6f * t.rock_slope), hn::Sub(one, s.rock));
  s.scree = hn::Mul(loose, rising(hilly, 0.1f, 0.4f));
  // Streams carry stones where they fall, and walls drop them into the sea.
  const V bed = hn::Mul(rising(hn::Neg(hn::LoadU(d, r.ridge + i)), 0.55f, 0.85f),
                        hn::Mul(rising(hilly, 0.15f, 0.4f), rising(steep, 0.08f, 0.25f)));
  const V tide = hn::Mul(rising(height, -5.0f, -1.0f), hn::Sub(one, rising(height, 2.0f, 12.0f)));
  const V foot = hn::Mul(tide, rising(hn::LoadU(d, r.cliff + i), 8.0f, 30.0f));
  s.stones = hn::Mul(hn::Max(s.scree, hn::Max(bed, foot)), hn::Sub(one, beach));
  return s;
}

void detail_row(const DetailTerms& t, const DetailRow& r, const BoulderRow& boulder, const BoulderRow& block,
                std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto noise = [&](const DetailNoise& n) {
      return Jet<V>{hn::LoadU(d, n.v + i), hn::LoadU(d, n.x + i), hn::LoadU(d, n.z + i)};
    };
    const auto by = [&](const Jet<V>& a, V share) {
      return Jet<V>{hn::Mul(a.v, share), hn::Mul(a.x, share), hn::Mul(a.z, share)};
    };
    const V gx = hn::LoadU(d, r.slope_x + i);
    const V gz = hn::LoadU(d, r.slope_z + i);
    const V steep = hn::Sqrt(hn::Add(hn::Mul(gx, gx), hn::Mul(gz, gz)));
    const GroundShares<V> s = shares_of(d, t, r, i, steep);
    const V hilly = hn::LoadU(d, r.hilliness + i);
    const V beach = hn::LoadU(d, r.beach + i);

    // Scree and sand lie smooth.
    const V smooth =
        hn::Mul(hn::Sub(one, hn::Mul(s.scree, hn::Set(d, 0.65f))), hn::Sub(one, hn::Mul(beach, hn::Set(d, 0.92f))));
    const V rough = hn::Mul(hn::Add(hn::Set(d, t.rough_plain), hn::Mul(hilly, hn::Set(d, t.rough_hill))), smooth);
    Jet<V> sum = by(noise(r.rough), rough);

    const auto crease = [&](const Jet<V>& n) {
      return Jet<V>{hn::Abs(n.v), hn::CopySign(n.x, hn::Xor(n.x, n.v)), hn::CopySign(n.z, hn::Xor(n.z, n.v))};
    };
    const V into = hn::Mul(s.rock, hn::Min(steep, hn::Set(d, kJointSlopeMax)));
    const Jet<V> joints = crease(noise(r.joint_broad)) + crease(noise(r.joint_fine)) * 0.4f;
    sum = sum + by(joints, hn::Mul(into, hn::Set(d, t.joint)));

    sum = sum + by(boulders(d, boulder, i), hn::Mul(s.stones, hn::Set(d, t.boulder)));
    sum = sum + by(boulders(d, block, i), hn::Mul(s.stones, hn::Set(d, t.block)));
    const auto add = [&](V change, float* to) { hn::StoreU(hn::Add(hn::LoadU(d, to + i), change), d, to + i); };
    add(sum.v, r.height);
    add(sum.x, r.slope_x);
    add(sum.z, r.slope_z);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(detail_row);

namespace {

/// Blocks are fewer and larger than boulders.
constexpr double kBlocksPerBoulder = 0.35;
constexpr double kBlockScale = 2.4;
/// They are flatter too.
constexpr double kBlockHeight = 0.7;

/// Where a grid's columns lie among the cells of one size of boulders.
struct BoulderAxes {
  Axis x;
  Axis z;
};

void split(const ColumnGrid& grid, double cell_m, std::uint64_t seed, BoulderAxes& out) {
  const Octave octave = octave_on(grid, 1 / cell_m, seed);
  split_axis(octave, 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, 0, 2, out.x);
  split_axis(octave, 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, 0, 2, out.z);
}

BoulderRow row_of(const BoulderAxes& axes, std::size_t k, double cell_m, double share) {
  return {&axes.x,
          axes.z.fraction[k],
          {axes.z.cell_hash[0][k], axes.z.cell_hash[1][k]},
          static_cast<float>(1 / cell_m),
          static_cast<float>(share)};
}

}  // namespace

void add_detail(const DetailControls& c, const ColumnGrid& grid, const DetailInput& in, const DetailSurface& surface,
                std::span<float> workspace) {
  const std::size_t stride = row_stride(grid);
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(in.hilliness.size() >= count && in.ridge.size() >= count && in.cliff_m.size() >= count);
  TALUS_CHECK(in.beach.size() >= count && surface.height_m.size() >= count && surface.slope_x.size() >= count);
  TALUS_CHECK(surface.slope_z.size() >= count && workspace.size() >= kDetailArrays * count);
  const auto seed = [&](std::uint64_t use) { return mix64(c.seed, use); };
  const std::array<FractalNoise, 3> noises{{c.rough, {13, 1, 2, 0.5, seed(1)}, {5, 1, 2, 0.5, seed(2)}}};
  for (std::size_t n = 0; n < noises.size(); ++n) {
    const auto array = [&](std::size_t part) { return workspace.subspan((n * 3 + part) * count, count); };
    fractal_noise(noises[n], grid, array(0), array(1), array(2));
  }
  const auto noise = [&](std::size_t n, std::size_t at) {
    const auto array = [&](std::size_t part) { return &workspace[(n * 3 + part) * count + at]; };
    return DetailNoise{array(0), array(1), array(2)};
  };
  const double block_m = kBlockScale * c.boulder_m;
  BoulderAxes boulder;
  BoulderAxes block;
  split(grid, c.boulder_m, seed(3), boulder);
  split(grid, block_m, seed(4), block);
  const auto f = [](double v) { return static_cast<float>(v); };
  const DetailTerms terms{f(c.rough_plain_m), f(c.rough_hill_m), f(c.joint_m),
                          f(c.rock_slope),    f(c.boulder_m),    f(kBlockHeight * block_m)};
  const auto run = HWY_DYNAMIC_DISPATCH(detail_row);
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const std::size_t at = k * stride;
    run(terms,
        {noise(0, at), noise(1, at), noise(2, at), &in.hilliness[at], &in.ridge[at], &in.cliff_m[at], &in.beach[at],
         &surface.height_m[at], &surface.slope_x[at], &surface.slope_z[at]},
        row_of(boulder, k, c.boulder_m, c.boulder_share),
        row_of(block, k, block_m, kBlocksPerBoulder * c.boulder_share), static_cast<std::size_t>(grid.width));
  }
}

double detail_bound(const DetailControls& c) {
  const auto one = static_cast<double>(kNoiseScale);
  const double rough = (c.rough_plain_m + c.rough_hill_m) * noise_bound(c.rough);
  const double joints = 1.4 * one * static_cast<double>(kJointSlopeMax) * c.joint_m;
  return rough + joints + 0.3 * c.boulder_m * (1 + kBlockHeight * kBlockScale);
}

}  // namespace talus
#endif  // HWY_ONCE
