#include "core/map/section.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/check.hpp"
#include "core/map/palette.hpp"

namespace talus {
namespace {

constexpr glm::vec3 kSkyLow = light_of(0xDCE6EE);
constexpr glm::vec3 kSkyHigh = light_of(0x9FBFDD);
constexpr glm::vec3 kCave = light_of(0x2B2A30);
constexpr glm::vec3 kSurfaceLine = light_of(0x2C231C);
constexpr glm::vec3 kDeepRock = light_of(0x4A433F);

/// The spacing of lattice columns and layers to read: the largest power of two of voxels that is no wider than a pixel.
std::int64_t step_for(double pixel_m, double voxel_m) {
  std::int64_t step = 1;
  while (static_cast<double>(step * 2) * voxel_m <= pixel_m) step *= 2;
  return step;
}

/// One picture column over its place.
class Column {
 public:
  Column(const WorldFunction& world, const SectionView& view, int i, DensityBrick& brick)
      : world_(world), view_(view), brick_(brick), pixel_m_((view.high_m - view.low_m) / view.height) {
    const double along = (static_cast<double>(i) + 0.5) / view.width;
    const glm::dvec2 place = (view.from_m + (view.to_m - view.from_m) * along) / world.voxel_m();
    step_ = step_for(pixel_m_, world.voxel_m());
    const auto cell = [&](double c) { return static_cast<std::int64_t>(std::floor(c / static_cast<double>(step_))); };
    corner_ = glm::i64vec2(cell(place.x), cell(place.y)) * step_;
    fraction_ = (place - glm::dvec2(corner_)) / static_cast<double>(step_);
    brick_.stand(world, corner_.x, corner_.y, step_, 1);
    y_voxel_ = cell(view.low_m / world.voxel_m()) * step_;
    const double layers = (view.high_m / world.voxel_m() - static_cast<double>(y_voxel_)) / static_cast<double>(step_);
    brick_.sample(world, y_voxel_, static_cast<int>(std::ceil(layers)) + 2);
  }

  double density(double y_m) const {
    const double y = (y_m / world_.voxel_m() - static_cast<double>(y_voxel_)) / static_cast<double>(step_);
    return brick_.density({fraction_.x, y, fraction_.y});
  }

  void draw(std::uint8_t* out, std::size_t row_bytes) const {
    bool is_roofed = false;
    float depth_m = 0;  // of unbroken rock above
    for (int k = 0; k < view_.height; ++k, out += row_bytes) {
      const double y_m = view_.high_m - (static_cast<double>(k) + 0.5) * pixel_m_;
      const double d = density(y_m);
      glm::vec3 light;
      if (d < 0) {
        light = rock(y_m, depth_m);
        depth_m += static_cast<float>(pixel_m_);
        is_roofed = true;
      } else {
        light = is_roofed ? cavity(y_m) : open(y_m);
        depth_m = 0;
      }
      // The surface is a line one and a half pixels wide: the density is a distance.
      const auto near = static_cast<float>(std::abs(d) / (0.75 * pixel_m_));
      if (near < 1.0f) light = mix(kSurfaceLine, light, near);
      for (std::size_t c = 0; c < 3; ++c) {
        const float v = std::sqrt(std::clamp(light[static_cast<int>(c)], 0.0f, 1.0f));
        out[c] = static_cast<std::uint8_t>(v * 255.0f + 0.5f);
      }
    }
  }

 private:
  glm::vec3 rock(double y_m, float depth_m) const {
    const ColumnBlock& b = brick_.columns();
    const auto height = static_cast<float>(y_m);
    const RockPlace place{b.stack_m[0], b.choice[0], height, corner_, step_};
    const LayerPlace layer = world_.layer(place);
    const glm::vec3 material = light_of(info_of(world_.rock(place)).colour_rgb);
    // Neighbouring layers of one rock differ a little, so that bedding shows.
    const float shade = 0.82f + 0.36f * category_light(static_cast<std::uint64_t>(layer.index)).x;
    return mix(material * shade, kDeepRock, depth_m / 2500.0f);
  }

  /// Air or water under a roof.
  glm::vec3 cavity(double y_m) const {
    return y_m < 0 ? mix(sea_light(static_cast<float>(-y_m)), kCave, 0.45f) : kCave;
  }

  glm::vec3 open(double y_m) const {
    if (y_m < 0) return sea_light(static_cast<float>(-y_m));
    return mix(kSkyLow, kSkyHigh, static_cast<float>(y_m / std::max(view_.high_m, 1.0)));
  }

  const WorldFunction& world_;
  const SectionView& view_;
  DensityBrick& brick_;
  double pixel_m_;
  std::int64_t step_ = 1;
  glm::i64vec2 corner_{};
  glm::dvec2 fraction_{};
  std::int64_t y_voxel_ = 0;
};

}  // namespace

glm::dvec2 section_heights(const WorldFunction& world, const SectionView& view, int count, SectionScratch& scratch) {
  glm::dvec2 out{1e9, -1e9};
  for (int i = 0; i < count; ++i) {
    const double along = (static_cast<double>(i) + 0.5) / count;
    const glm::dvec2 place = glm::floor((view.from_m + (view.to_m - view.from_m) * along) / world.voxel_m());
    scratch.brick.stand(world, static_cast<std::int64_t>(place.x), static_cast<std::int64_t>(place.y), 1, 1);
    out.x = std::min(out.x, scratch.brick.rock_below_m());
    out.y = std::max(out.y, scratch.brick.air_above_m());
  }
  return out;
}

void draw_section_column(const WorldFunction& world, const SectionView& view, int i, SectionScratch& scratch,
                         std::span<std::uint8_t> rgb) {
  TALUS_CHECK(i >= 0 && i < view.width && view.high_m > view.low_m);
  const auto row_bytes = static_cast<std::size_t>(view.width) * 3;
  TALUS_CHECK(rgb.size() >= row_bytes * static_cast<std::size_t>(view.height));
  Column(world, view, i, scratch.brick).draw(&rgb[static_cast<std::size_t>(i) * 3], row_bytes);
}

}  // namespace talus
