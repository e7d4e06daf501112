#include "core/map/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"

namespace talus {
namespace {

/// Columns along a block's edge: four blocks of this size fill a tile of 256 pixels.
constexpr int kBlockColumns = 128;
static_assert(kBlockColumns <= kColumnsMax);

/// Colours of single columns.
class Painter {
 public:
  Painter(const WorldFunction& world, MapLayer layer, ColumnWorkspace& plates)
      : world_(world), layer_(layer), land_(world.manifest()), plates_(plates) {
    const glm::dvec2 range = world.height_range_m();
    low_m_ = static_cast<float>(range.x);
    span_m_ = static_cast<float>(range.y - range.x);
  }

  glm::vec3 colour(const ColumnBlock& b, int i, int k) const {
    const std::size_t at = static_cast<std::size_t>(k) * b.stride + static_cast<std::size_t>(i);
    const float height = b.height_m[at];
    switch (layer_) {
      case MapLayer::kShaded:
        return land_.land(height, material(b, i, k, at), dryness(b, at)) *
               (1.0f + 0.14f * b.ridge[at] * b.hilliness[at]);
      case MapLayer::kHeight:
        return heat_light((height - low_m_) / span_m_);
      case MapLayer::kSlope:
        // Vertical is bright: 1 - the cosine of the slope's angle would hide gentle slopes.
        return heat_light(std::sqrt(1.0f - b.steepness[at] * b.steepness[at]));
      case MapLayer::kMaterial:
        return light_of(info_of(material(b, i, k, at)).colour_rgb);
      case MapLayer::kLayer: {
        const LayerPlace place = world_.layer(rock_place(b, i, k, at));
        return category_light(static_cast<std::uint64_t>(place.set) * kLayers +
                              static_cast<std::uint64_t>(place.index));
      }
      case MapLayer::kRidge: {
        const float v = 0.5f + 0.5f * b.ridge[at];
        return glm::vec3(v * v);
      }
      case MapLayer::kHilliness:
        return heat_light(b.hilliness[at]);
      case MapLayer::kPlates:
        return plate(b, i, k, at);
      case MapLayer::kFaults:
        return fault(b, i, k, at);
      case MapLayer::kDistrictWeights:
        return district(b, at);
    }
    return {};
  }

 private:
  static glm::i64vec2 column_voxel(const ColumnBlock& b, int i, int k) {
    return {b.grid.x_voxel + i * b.grid.step_voxel, b.grid.z_voxel + k * b.grid.step_voxel};
  }

  static RockPlace rock_place(const ColumnBlock& b, int i, int k, std::size_t at) {
    return {b.stack_m[at], b.choice[at], b.height_m[at], column_voxel(b, i, k), b.grid.step_voxel};
  }

  PlatePlace plate_at(const ColumnBlock& b, int i, int k) const {
    return world_.plate_at(glm::dvec2(column_voxel(b, i, k)) * b.grid.voxel_m, plates_);
  }

  glm::vec3 plate(const ColumnBlock& b, int i, int k, std::size_t at) const {
    const PlatePlace place = plate_at(b, i, k);
    const auto [x, z] = place.plate.key;
    const glm::vec3 ground =
        plate_light(place.traits.kind, mix64(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(z)));
    const auto line_m = static_cast<float>(1.5 * static_cast<double>(b.grid.step_voxel) * b.grid.voxel_m);
    // The shore shows through: what is dry is lighter than what is not.
    const glm::vec3 shown = ground * (b.height_m[at] < 0 ? 0.8f : 1.15f);
    return std::abs(place.fault_m) < line_m ? fault_light(place.fault) : shown;
  }

  glm::vec3 fault(const ColumnBlock& b, int i, int k, std::size_t at) const {
    constexpr float kGlow_m = 3500.0f;
    const PlatePlace place = plate_at(b, i, k);
    const float near = std::max(0.0f, 1.0f - std::abs(place.fault_m) / kGlow_m);
    const glm::vec3 ground = light_of(b.height_m[at] < 0 ? 0x17202B : 0x3A3F42);
    return ground + (fault_light(place.fault) - ground) * (near * near);
  }

  /// Every district as far as it has the ground; heights show through.
  glm::vec3 district(const ColumnBlock& b, std::size_t at) const {
    const float high = std::clamp(b.height_m[at] / 1200.0f, 0.0f, 1.0f);
    glm::vec3 out = light_of(b.height_m[at] < 0 ? 0x22303E : 0x5A5C58) * (1.0f + 0.8f * high);
    const DistrictShares shares = b.districts_at(at);
    for (std::size_t n = 0; n < kDistricts; ++n) out = mix(out, district_light(static_cast<District>(n)), shares[n]);
    return out;
  }

  /// How little grows: badlands are barer than table land.
  static float dryness(const ColumnBlock& b, std::size_t at) {
    const DistrictShares shares = b.districts_at(at);
    return shares[static_cast<std::size_t>(District::kBadlands)] +
           0.55f * shares[static_cast<std::size_t>(District::kMesas)];
  }

  Material material(const ColumnBlock& b, int i, int k, std::size_t at) const {
    const glm::i64vec2 voxel = column_voxel(b, i, k);
    const Material cover = world_.cover({b.height_m[at], b.steepness[at], b.ridge[at], b.hilliness[at], b.beach[at],
                                         voxel, b.districts_at(at), b.grid.step_voxel});
    return cover == Material::kRock ? world_.rock(rock_place(b, i, k, at)) : cover;
  }

  const WorldFunction& world_;
  MapLayer layer_;
  LandPalette land_;
  ColumnWorkspace& plates_;
  float low_m_ = 0;
  float span_m_ = 1;
};

/// Adds the columns of a block to the pixels they lie in; (i0, k0) is the block's first column within the view.
void add_block(const Painter& painter, MapLayer layer, const ColumnBlock& b, int samples, int i0, int k0, Ground& out) {
  for (int k = 0; k < b.grid.depth; ++k) {
    const std::size_t row = static_cast<std::size_t>((k0 + k) / samples) * out.stride;
    for (int i = 0; i < b.grid.width; ++i) {
      const std::size_t pixel = row + static_cast<std::size_t>((i0 + i) / samples);
      const float height = b.height_m[static_cast<std::size_t>(k) * b.stride + static_cast<std::size_t>(i)];
      out.height_m[pixel] += height;
      if (has_sea(layer) && height < 0.0f) {
        out.wet[pixel] += 1.0f;
      } else {
        out.colour[pixel] += painter.colour(b, i, k);
      }
    }
  }
}

/// Sums become means.
void divide(int samples, Ground& out) {
  const auto all = static_cast<float>(samples * samples);
  for (std::size_t pixel = 0; pixel < out.wet.size(); ++pixel) {
    const float dry = all - out.wet[pixel];
    out.height_m[pixel] /= all;
    out.wet[pixel] /= all;
    if (dry > 0.0f) out.colour[pixel] /= dry;
  }
}

}  // namespace

void gather_ground(const WorldFunction& world, const MapView& view, MapLayer layer, int margin, MapScratch& scratch) {
  TALUS_CHECK(view.width > 0 && view.height > 0 && view.samples > 0);
  TALUS_CHECK(view.pixel_voxels % view.samples == 0);
  const int width = view.width + 2 * margin;
  const int height = view.height + 2 * margin;
  Ground& out = scratch.ground;
  out.margin = margin;
  out.stride = static_cast<std::size_t>(width);
  const std::size_t pixels = out.stride * static_cast<std::size_t>(height);
  out.height_m.assign(pixels, 0.0f);
  out.wet.assign(pixels, 0.0f);
  out.colour.assign(pixels, glm::vec3(0.0f));

  const Painter painter(world, layer, scratch.plates);
  const std::int64_t step = view.pixel_voxels / view.samples;
  const int columns = width * view.samples;
  const int rows = height * view.samples;
  for (int k0 = 0; k0 < rows; k0 += kBlockColumns) {
    for (int i0 = 0; i0 < columns; i0 += kBlockColumns) {
      ColumnGrid grid;
      grid.x_voxel = view.x_voxel - margin * view.pixel_voxels + i0 * step;
      grid.z_voxel = view.z_voxel - margin * view.pixel_voxels + k0 * step;
      grid.step_voxel = step;
      grid.width = std::min(kBlockColumns, columns - i0);
      grid.depth = std::min(kBlockColumns, rows - k0);
      grid.voxel_m = world.voxel_m();
      world.columns(grid, scratch.columns);
      add_block(painter, layer, scratch.columns, view.samples, i0, k0, out);
    }
  }
  divide(view.samples, out);
}

}  // namespace talus
