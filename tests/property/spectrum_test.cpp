// The world is as fine at 10^9 m as at its origin: rows of heights have the same spectrum there.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/world/world_function.hpp"
#include "tests/support/random.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kSpectrumSeed = 43;
constexpr int kSamples = 128;
/// Bands of wavenumbers, each twice as fine as the one before: 1..2, 2..4 ... 32..63 waves a row.
constexpr std::size_t kBands = 6;
using Bands = std::array<double, kBands>;

/// Amplitudes of a row by the definition of the transform, of the second difference so that neither the country's level
/// nor its slope leaks into the fine bands.
void add_power(const std::vector<double>& row, Bands& out) {
  const auto n = row.size();
  for (std::size_t wave = 1; wave < 64; ++wave) {
    double real = 0;
    double imaginary = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * t);
      const double angle = 2 * std::numbers::pi * static_cast<double>(wave * i) / static_cast<double>(n);
      real += window * row[i] * std::cos(angle);
      imaginary += window * row[i] * std::sin(angle);
    }
    out[static_cast<std::size_t>(std::log2(static_cast<double>(wave)))] += real * real + imaginary * imaginary;
  }
}

/// Mean logarithm of the power in each band over many rows of dry land around a place.
struct Spectrum {
  Bands log_power{};
  int rows = 0;
};

Spectrum spectrum_at(const WorldFunction& world, double far_m, std::int64_t step) {
  Spectrum out;
  test::Random random(kSpectrumSeed);
  ColumnBlock block;
  const auto far = static_cast<std::int64_t>(far_m);
  for (int n = 0; n < 900 && out.rows < 240; ++n) {
    const auto sign = [&] { return random.bits() % 2 == 0 ? 1 : -1; };
    const std::int64_t x = sign() * far + random.whole(-400'000, 400'000);
    const std::int64_t z = sign() * far + random.whole(-400'000, 400'000);
    world.columns({x, z, step, kSamples + 2, 1, 1.0}, block);
    if (block.height_low_m < 20.0f) continue;
    std::vector<double> bends(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const auto h = [&](std::size_t at) { return static_cast<double>(block.height_m[at]); };
      bends[i] = h(i) - 2 * h(i + 1) + h(i + 2);
    }
    Bands power{};
    add_power(bends, power);
    for (std::size_t b = 0; b < kBands; ++b) out.log_power[b] += std::log(power[b] + 1e-12);
    ++out.rows;
  }
  for (double& p : out.log_power) p /= out.rows;
  return out;
}

TEST(Spectrum, IsTheSameAtABillionMetresAsAtTheOrigin) {
  const WorldFunction world{Manifest()};
  for (const std::int64_t step : {1, 16}) {
    const Spectrum here = spectrum_at(world, 0, step);
    const Spectrum there = spectrum_at(world, 1e9 - 500'000, step);
    ASSERT_GT(here.rows, 120);
    ASSERT_GT(there.rows, 120);
    for (std::size_t b = 0; b < kBands; ++b) {
      // Single rows differ by e^2 and more, from plain to range; means of 240 by a standard error of about 0.2.
      EXPECT_NEAR(there.log_power[b], here.log_power[b], 0.8)
          << "band " << b << " at a step of " << step << " m, seed " << kSpectrumSeed;
    }
  }
}

TEST(Spectrum, WouldShowStairsOfTheWidthOfAFloat) {
  // What positions in floats would do at 10^9 m, 64 m apart: rows sampled in steps, whose fine bands are those of
  // walls.
  const WorldFunction world{Manifest()};
  test::Random random(kSpectrumSeed);
  ColumnBlock block;
  Bands smooth{};
  Bands stairs{};
  int rows = 0;
  while (rows < 40) {
    world.columns({random.whole(-400'000, 400'000), random.whole(-400'000, 400'000), 1, kSamples + 2, 1, 1.0}, block);
    if (block.height_low_m < 20.0f) continue;
    std::vector<double> bends(kSamples);
    std::vector<double> steps(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const auto h = [&](std::size_t at) { return static_cast<double>(block.height_m[at]); };
      const auto s = [&](std::size_t at) { return h(at / 64 * 64); };
      bends[i] = h(i) - 2 * h(i + 1) + h(i + 2);
      steps[i] = s(i) - 2 * s(i + 1) + s(i + 2);
    }
    Bands power{};
    add_power(bends, power);
    Bands stepped{};
    add_power(steps, stepped);
    for (std::size_t b = 0; b < kBands; ++b) {
      smooth[b] += std::log(power[b] + 1e-12) / 40;
      stairs[b] += std::log(stepped[b] + 1e-12) / 40;
    }
    ++rows;
  }
  EXPECT_GT(std::abs(stairs[kBands - 1] - smooth[kBands - 1]), 1.2) << "the test above could not see them";
}

}  // namespace
}  // namespace talus
