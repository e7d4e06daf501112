#include "client_sample/cli/block_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "client_sample/cli/strips.hpp"
#include "client_sample/cli/world_block.hpp"
#include "core/map/palette.hpp"

namespace talus::cli {
namespace {

/// Voxels along the block's edges: what a picture of 200 m sees at any angle, from below the sea to above cliffs.
constexpr int kPictureEdge = 288;
constexpr int kPictureHeight = 224;
/// Where it begins at a coast; inland the block lies around what is in the middle of the picture.
constexpr int kPictureBottom = -16;
/// Rays step this many voxels; a surface thinner than that may be missed.
constexpr double kStep = 0.6;
/// Where the sun stands: to the right, up and towards the eye, so that every view is lit from the side.
constexpr glm::dvec3 kSun{0.62, 0.62, 0.48};
constexpr glm::vec3 kSunLight{1.12f, 1.05f, 0.92f};
constexpr glm::vec3 kSkyLight{0.46f, 0.52f, 0.62f};
constexpr glm::vec3 kSkyLow = light_of(0xDCE6EE);
constexpr glm::vec3 kSkyHigh = light_of(0x9FBFDD);
constexpr glm::vec3 kSea = light_of(0x2E6F80);

/// The block as a field one can walk through; places in voxels from its corner.
class Block {
 public:
  Block(const WorldFunction& world, glm::dvec3 middle_m, const glm::dvec3& sun) : world_(world), sun_(sun) {
    const glm::i64vec3 middle(glm::floor(middle_m / world.voxel_m()));
    const std::int64_t bottom = std::max<std::int64_t>(kPictureBottom, middle.y - kPictureHeight / 2);
    samples_ = {{middle.x - kPictureEdge / 2, bottom, middle.z - kPictureEdge / 2},
                kPictureEdge,
                kPictureHeight,
                kPictureEdge,
                {},
                {},
                {},
                {}};
    DensityBrick brick;
    sample_block(world, brick, samples_);
  }

  /// Height of its lowest voxels.
  double bottom_voxel() const { return static_cast<double>(samples_.corner_voxel.y); }

  bool holds(const glm::dvec3& p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < kPictureEdge - 1 && p.y < kPictureHeight - 1 &&
           p.z < kPictureEdge - 1;
  }

  double density(const glm::dvec3& place) const {
    const glm::dvec3 p = glm::clamp(place, glm::dvec3(0),
                                    glm::dvec3(kPictureEdge - 1.001, kPictureHeight - 1.001, kPictureEdge - 1.001));
    const glm::ivec3 cell(p);
    std::array<float, 8> corners{};
    for (int c = 0; c < 8; ++c) {
      corners[static_cast<std::size_t>(c)] =
          samples_.density[samples_.at(cell.x + (c & 1), cell.y + (c >> 1 & 1), cell.z + (c >> 2))];
    }
    return trilinear(corners, p - glm::dvec3(cell));
  }

  /// The first rock along a ray, from `begin` voxels on.
  std::optional<glm::dvec3> first_rock(const glm::dvec3& from, const glm::dvec3& direction, double begin,
                                       double end) const {
    const int steps = static_cast<int>(std::ceil((end - begin) / kStep));
    for (int step = 0; step < steps; ++step) {
      const double t = begin + step * kStep;
      const glm::dvec3 here = from + direction * t;
      if (!holds(here) || density(here) >= 0) continue;
      double low = t - kStep;
      double high = t;
      for (int n = 0; n < 8; ++n) {
        const double middle = 0.5 * (low + high);
        (density(from + direction * middle) < 0 ? high : low) = middle;
      }
      return from + direction * low;
    }
    return std::nullopt;
  }

  glm::vec3 colour(const glm::dvec3& p, const glm::dvec3& normal) const {
    const glm::ivec3 cell(p);
    const std::size_t column = static_cast<std::size_t>(cell.z) * kPictureEdge + static_cast<std::size_t>(cell.x);
    const auto height = static_cast<float>((p.y + bottom_voxel()) * world_.voxel_m());
    const glm::i64vec2 voxel{samples_.corner_voxel.x + cell.x, samples_.corner_voxel.z + cell.z};
    if (normal.y > 0.75 && height > samples_.height_m[column] - 2) return light_of(0x6B7A45);
    const RockPlace place{samples_.stack_m[column], samples_.choice[column], height, voxel};
    const LayerPlace layer = world_.layer(place);
    const Material rock = world_.rock(place);
    return light_of(info_of(rock).colour_rgb) *
           (0.8f + 0.4f * category_light(static_cast<std::uint64_t>(layer.index)).x);
  }

  /// Light that reaches a place, and its colour. Where the block's border cuts rock there is no surface to light.
  glm::vec3 shade(const glm::dvec3& p) const {
    if (std::min({p.x, p.z, kPictureEdge - 1 - p.x, kPictureEdge - 1 - p.z}) < 1)
      return colour(glm::max(p, glm::dvec3(0)), {}) * 0.6f;
    const auto slope = [&](const glm::dvec3& side) { return density(p + side) - density(p - side); };
    const glm::dvec3 gradient(slope({0.8, 0, 0}), slope({0, 0.8, 0}), slope({0, 0, 0.8}));
    const glm::dvec3 normal = gradient / std::max(glm::length(gradient), 1e-6);
    auto lit = static_cast<float>(std::max(glm::dot(normal, sun_), 0.0));
    if (lit > 0 && first_rock(p + normal * 0.7, sun_, kStep, 120)) lit = 0;
    // Air around: how open the place is, from the density a few voxels out along the normal.
    float open = 0;
    for (const double out : {2.0, 5.0, 10.0}) {
      open += static_cast<float>(std::clamp(density(p + (normal + glm::dvec3(0, 0.4, 0)) * out) / out, 0.0, 1.0)) / 3;
    }
    const float sky = (0.35f + 0.65f * open) * (0.7f + 0.3f * static_cast<float>(normal.y));
    return colour(p, normal) * (kSunLight * lit + kSkyLight * sky);
  }

 private:
  const WorldFunction& world_;
  WorldBlock samples_;
  glm::dvec3 sun_;
};

glm::vec3 pixel(const Block& block, const glm::dvec3& from, const glm::dvec3& direction, double reach, double rise) {
  const auto rock = block.first_rock(from, direction, 0, reach);
  const double sea = direction.y < 0 ? (-block.bottom_voxel() - from.y) / direction.y : reach;
  const glm::vec3 sky = glm::mix(kSkyLow, kSkyHigh, static_cast<float>(std::clamp(rise, 0.0, 1.0)));
  if (rock && glm::dot(*rock - from, direction) < sea) return block.shade(*rock);
  if (sea >= reach) return sky;
  const double depth = rock ? glm::dot(*rock - from, direction) - sea : 40;
  const glm::vec3 floor = rock ? block.shade(*rock) : kSea;
  const glm::vec3 water = glm::mix(kSea, floor, static_cast<float>(std::exp(-0.22 * depth)));
  return glm::mix(water, kSkyLow, 0.12f);
}

}  // namespace

Picture draw_block(const WorldFunction& world, const BlockView& view, int width, int height) {
  Picture out{width, height, {}};
  out.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const double yaw = view.yaw * std::numbers::pi / 180;
  const double pitch = view.pitch * std::numbers::pi / 180;
  const glm::dvec3 forward(-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
  const glm::dvec3 right(std::cos(yaw), 0, -std::sin(yaw));
  const glm::dvec3 up = glm::cross(right, forward);
  const Block block(world, view.middle_m, glm::normalize(right * kSun.x + glm::dvec3(0, kSun.y, 0) - forward * kSun.z));
  const glm::dvec3 middle(kPictureEdge / 2.0, view.middle_m.y / world.voxel_m() - block.bottom_voxel(),
                          kPictureEdge / 2.0);
  const double scale = view.width_m / world.voxel_m() / width;
  constexpr double kReach = 2.0 * kPictureEdge;
  for_each_strip("block", height, [&](int k, int) {
    std::uint8_t* rgb = &out.rgb[static_cast<std::size_t>(k) * static_cast<std::size_t>(width) * 3];
    for (int i = 0; i < width; ++i) {
      const glm::dvec3 from = middle + right * ((i + 0.5 - width / 2.0) * scale) +
                              up * ((height / 2.0 - k - 0.5) * scale) - forward * (kReach / 2);
      const glm::vec3 light = pixel(block, from, forward, kReach, 1 - static_cast<double>(k) / height);
      for (int c = 0; c < 3; ++c) {
        *rgb++ = static_cast<std::uint8_t>(std::sqrt(std::clamp(light[c], 0.0f, 1.0f)) * 255.0f + 0.5f);
      }
    }
  });
  return out;
}

}  // namespace talus::cli
