// Settings of warp and carving, as the manifest gives them. Lengths in metres.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace talus {

struct WarpControls {
  float reach_m = 4;     ///< how far the hardest beds stand out; 0: no warp
  float slope_low = 0;   ///< slope of the land at which beds begin to stand out
  float slope_high = 1;  ///< and from which they do so fully
  double patch_m = 120;  ///< wavelength of places with more and less of it
  std::uint64_t seed = 0;
};

/// One pass of carving: where its seeds are accepted, and the spheres that grow from them.
struct CarvePass {
  double cell_m = 26;  ///< edge of the cells that hold one candidate each
  float probability = 0;
  float slope_min = 1;
  float elevation_low_m = 0, elevation_high_m = 4;
  float radius_low_m = 3, radius_high_m = 6;
  int steps_low = 1, steps_high = 1;      ///< of growth from a seed
  int spheres_low = 1, spheres_high = 1;  ///< at each step
  float step_m = 3;
  float jitter = 0.5f;   ///< displacement of a sphere, of its radius; 0.4 of that vertically
  float fall = 0;        ///< metres down per metre inwards
  float stretch = 1;     ///< vertical radius over horizontal radius
  float end_radius = 1;  ///< radius of the last step over that of the first
  float roof_m = 3;      ///< rock that must stay above a sphere, plus 0.35 of its radius
};

/// Passes in the order in which their spheres are joined. Arches go through a headland instead of into a wall: their
/// steps are as many as it takes.
enum class CarveKind : std::uint8_t { kNotch, kCaves, kAlcoves, kArches };
inline constexpr std::size_t kCarvePasses = 4;

struct CarveControls {
  std::array<CarvePass, kCarvePasses> passes;
  float arch_span_m = 60;  ///< longest way under an arch
  float union_m = 1.2f;    ///< width over which spheres flow into each other
  float blend_m = 1.6f;    ///< width over which a wall of a cave rounds into the surface
  float roughness_m = 0.7f;
  std::uint64_t seed = 0;

  const CarvePass& pass(CarveKind kind) const { return passes[static_cast<std::size_t>(kind)]; }
};

/// A carved point feels no sphere whose wall is further away than this: there the distance to carved space is infinite,
/// so that what a chunk did not gather cannot be missed.
inline constexpr float kCarveBand_m = 5.0f;
/// Roughness fades out between these distances from a wall.
inline constexpr float kRoughFull_m = 1.0f;
inline constexpr float kRoughEnd_m = 3.0f;
/// Horizontal reach of everything that grows from one seed, the band included. Manifests that reach further are
/// refused.
inline constexpr double kCarveReach_m = 88.0;

/// Coarse lattices do not see the volume at all, and by a rule at each point, not by leaving something out: on lattice
/// points of 16 m the warp is 0, around lattice columns of 16 m a pillar of rock stays uncarved, exactly so at the
/// column itself. Between the sea and the next level of that lattice, where nearly all arches and caves are, there is
/// no lattice point to keep: there pillars end in stumps just above the water and in what hangs just below 16 m. Chunks
/// of such LODs need not look for spheres or fans.
inline constexpr double kStill_m = 16.0;

/// How far beyond its radius a sphere can turn rock to air: flowing together at most union_m (h below is at most 1, and
/// the smooth minimum of values >= m stays >= m - union_m), rounding blend_m / 4, roughness its noise's bound.
constexpr float carve_swell_m(const CarveControls& c) {
  constexpr float kRoughBound = 1.5f * 1.5f;  // two octaves of amplitudes 1 and 0.5, each within +-1.5
  return c.union_m + 0.25f * c.blend_m + kRoughBound * c.roughness_m;
}

}  // namespace talus
