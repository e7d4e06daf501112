// A coast of cliffs, headlands and fins, made up for tests of the volume: what warp and carving need to have anything
// to work on, whatever the default world looks like at present.
//
// Raw height rises inland and carries fins and joints; a remap near the sea turns its gentle shore into a wall of up to
// 76 m. Double arithmetic in one order, so every machine sees the same coast.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/hash.hpp"
#include "core/volume/height_source.hpp"

namespace talus::test {

class CliffCoast final : public HeightSource {
 public:
  explicit CliffCoast(std::uint64_t seed, double voxel_m = 1.0) : seed_(seed), voxel_m_(voxel_m) {}

  std::uint64_t identity() const override { return mix64(seed_, 0xC11FF); }
  double voxel_m() const override { return voxel_m_; }
  std::span<const float> heights(const ColumnGrid& grid) override {
    const std::size_t stride = row_stride(grid);
    memory_.assign(sample_count(grid), 0.0f);
    for (int k = 0; k < grid.depth; ++k) {
      for (int i = 0; i < grid.width; ++i) {
        const auto at = static_cast<std::size_t>(k) * stride + static_cast<std::size_t>(i);
        memory_[at] = static_cast<float>(height(static_cast<double>(grid.x_voxel + i * grid.step_voxel) * voxel_m_,
                                                static_cast<double>(grid.z_voxel + k * grid.step_voxel) * voxel_m_));
      }
    }
    return memory_;
  }
  /// A hard bed over a soft one every 14 m, the lowest at 9 m.
  std::optional<float> ceiling_near(double /*x_m*/, double /*z_m*/, float height_m) override {
    return 9.0f + 14.0f * std::floor((height_m - 2.0f) / 14.0f);
  }

  /// 1 / sqrt(1 + slope^2) at a column of `grid`.
  float steepness(const ColumnGrid& grid, std::size_t i, std::size_t k) const {
    const double x = static_cast<double>(grid.x_voxel + static_cast<std::int64_t>(i) * grid.step_voxel) * voxel_m_;
    const double z = static_cast<double>(grid.z_voxel + static_cast<std::int64_t>(k) * grid.step_voxel) * voxel_m_;
    const double here = height(x, z);
    const double gx = height(x + 1, z) - here;
    const double gz = height(x, z + 1) - here;
    return static_cast<float>(1 / std::sqrt(1 + gx * gx + gz * gz));
  }

  /// The coast runs along x near z = 0, land where z is above.
  double height(double x, double z) const {
    const double mask = smooth(-0.35, 0.15, noise(x, z, 500, 500, 1));
    double raw = 0.16 * z + 14 * noise(x, z, 700, 700, 2) + 8 * noise(x, z, 150, 150, 3);
    raw += 11 * mask * noise(x + 0.35 * z, z, 64, 190, 4);
    raw += 1.1 * std::abs(noise(x, z, 19, 19, 5)) + 0.45 * std::abs(noise(x, z, 8, 8, 6));
    const double wall = std::max(18.0, 48 + 28 * noise(x, z, 700, 700, 7));
    return (raw < 0 ? 0.6 * raw : raw) + wall * smooth(-1.0, 2.4, raw);
  }

 private:
  static double smooth(double low, double high, double v) {
    const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  /// Gradient noise of about +-1.
  double noise(double x, double z, double wave_x, double wave_z, std::uint64_t use) const {
    const double px = x / wave_x + 0.37 * static_cast<double>(use);
    const double pz = z / wave_z + 0.71 * static_cast<double>(use);
    const double cx = std::floor(px);
    const double cz = std::floor(pz);
    const double fx = px - cx;
    const double fz = pz - cz;
    const auto corner = [&](int i, int k) {
      const auto cell = [](double c, int offset) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(c) + offset);
      };
      const std::uint64_t hash = mix64(mix64(seed_ + use, cell(cx, i)), cell(cz, k));
      const double gx = static_cast<double>(hash & 0xFFFF) / 32767.5 - 1;
      const double gz = static_cast<double>((hash >> 16) & 0xFFFF) / 32767.5 - 1;
      return 1.6 * (gx * (fx - i) + gz * (fz - k));
    };
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double u = fade(fx);
    const double w = fade(fz);
    const double near = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
    const double far = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
    return near + (far - near) * w;
  }

  std::uint64_t seed_;
  double voxel_m_;
  std::vector<float> memory_;
};

}  // namespace talus::test
