// How a layer's rock changes from place to place. Pure.
//
// Problem: a layer holds several rocks, each over its share of the land, in patches that hang together and differ from
// layer to layer. Answer: gradient noise whose lattice is hashed with the layer, turned into its own quantile: uniform
// over 0..1, so that the place where a cumulative distribution holds it gives every rock its probability.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace talus {

class Facies {
 public:
  /// `wavelength_m` of the larger patches; `wrap_m` is the world's period from east to west, or 0.
  Facies(double wavelength_m, double wrap_m);

  /// Quantile of the noise of `key` at a place, 0 <= quantile < 1.
  float quantile(std::uint64_t key, const glm::dvec2& place_m) const;

 private:
  /// One octave's cell edges, in metres, and how many make up a period.
  struct Octave {
    double edge_x_m, edge_z_m;
    std::int64_t cells_around;
  };
  static float noise(const Octave& octave, std::uint64_t key, const glm::dvec2& place_m);

  Octave wide_, narrow_;
};

}  // namespace talus
