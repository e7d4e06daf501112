// What lies on the ground (sand, scree, soil, grass, snow, stream beds), and the rock where it is bare.
#include <algorithm>
#include <cmath>

#include "core/base/hash.hpp"
#include "core/grid/wrap.hpp"
#include "core/world/terms.hpp"
#include "core/world/world_function.hpp"

namespace talus {
namespace {

/// Edge of the patches in which borders between covers sway, in metres.
constexpr double kPatch_m = 22.0;

/// Chance per column, -1/2 .. 1/2: what breaks the last straight line.
float speckle(std::uint64_t seed, glm::i64vec2 column_voxel) {
  const std::uint64_t hash =
      mix64(mix64(seed, static_cast<std::uint64_t>(column_voxel.x)), static_cast<std::uint64_t>(column_voxel.y));
  return static_cast<float>(hash >> 40) * 0x1p-24f - 0.5f;
}

/// Value noise, -1/2 .. 1/2: grass and scree advance in tongues and not in dots.
float patches(std::uint64_t seed, glm::i64vec2 column_voxel, double voxel_m) {
  const glm::dvec2 at = glm::dvec2(column_voxel) * (voxel_m / kPatch_m);
  const glm::dvec2 cell(std::floor(at.x), std::floor(at.y));
  const auto fade = [](double t) {
    const auto f = static_cast<float>(t);
    return f * f * (3.0f - 2.0f * f);
  };
  const float u = fade(at.x - cell.x);
  const float w = fade(at.y - cell.y);
  const glm::i64vec2 low(cell);
  const auto corner = [&](int x, int z) { return speckle(seed ^ 0x5EEDULL, low + glm::i64vec2(x, z)); };
  const float near = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
  const float far = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
  return near + (far - near) * w;
}

/// What is left of chance where a cell is wider than the patches it would make: dots on a far slope.
float chance_seen(std::int64_t step_voxel, double voxel_m) {
  return static_cast<float>(std::min(1.0, kPatch_m / (static_cast<double>(step_voxel) * voxel_m)));
}

RockPoint rock_point(const WorldFunction::Terms& t, const RockPlace& place) {
  const glm::i64vec2 voxel(wrapped(place.column_voxel.x, t.wrap_voxel), place.column_voxel.y);
  return {place.stack_m, place.choice, place.height_m, glm::dvec2(voxel) * t.voxel_m,
          static_cast<double>(place.step_voxel) * t.voxel_m};
}

}  // namespace

Material WorldFunction::cover(const CoverPlace& place) const {
  const Terms& t = *terms_;
  const float height = place.height_m;
  const float ridge = place.ridge;
  const glm::i64vec2 column_voxel(wrapped(place.column_voxel.x, t.wrap_voxel), place.column_voxel.y);
  const float seen = chance_seen(place.step_voxel, t.voxel_m);
  const float dot = seen * speckle(t.manifest.seed, column_voxel);
  const float sway = 0.2f * dot + seen * (1.2f * patches(t.manifest.seed, column_voxel, t.voxel_m));
  const float cosine = std::max(place.up, 0.05f);
  const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
  const float steep = slope + 0.16f * sway;
  // Badlands and table land are dry: rock is bare on gentler ground, and soil takes the place of grass.
  const float dry = place.districts[0] + place.districts[2];
  const float rock_slope = t.rock_slope * (1.0f - 0.55f * dry);

  // Shores: sand where there is a beach, shingle where walls stand, rock where it is steep.
  if (height < t.beach_m + 1.5f * sway && steep < 0.4f && height > -1.0f) {
    return place.beach > 0.4f + 0.25f * sway ? Material::kSand : Material::kScree;
  }
  if (height < -1.0f) return steep < t.rock_slope ? Material::kSand : Material::kRock;

  if (place.districts[1] + 0.25f * sway > 0.45f && steep < t.rock_slope) return Material::kSand;  // dunes

  // Snow lies deeper in couloirs and slides off walls.
  const float hollow = std::clamp(-ridge, 0.0f, 1.0f);
  const float cold = height + 150.0f * sway + 170.0f * hollow - t.snow_line_m;
  if (cold > 220.0f * (slope - 0.45f) && slope < 1.25f * rock_slope + 0.5f * hollow) return Material::kSnow;
  if (steep > rock_slope) return Material::kRock;

  // Water runs where hollows are sharp and fall, not in every crease of a meadow.
  if (ridge < -0.8f + 0.1f * dot && place.hilliness > 0.2f && slope > 0.1f && slope < 0.7f * rock_slope) {
    return Material::kStreamBed;
  }
  // Debris lies below walls and in gullies that end on them; ridges between keep their turf.
  const float loose = steep + 0.22f * hollow - 0.18f * std::max(ridge, 0.0f);
  if (loose > 0.78f * rock_slope) return Material::kScree;
  // Grass fades with height and on steep or wind-swept ground, first in patches of soil.
  const float bare = height + 170.0f * sway + 260.0f * (slope - 0.4f) + 60.0f * ridge - t.grass_line_m;
  if (bare > 60.0f) return steep > 0.4f ? Material::kScree : Material::kSoil;
  if (bare > -60.0f && steep > 0.3f) return Material::kSoil;
  if (dry + 0.5f * sway > 0.5f) return Material::kSoil;
  const float worn = steep + 0.1f * hollow;
  return worn > 0.62f * rock_slope ? Material::kSoil : Material::kGrass;
}

Material WorldFunction::sheltered(float height_m, float up) const {
  constexpr float kFloorUp = 0.8f;  // about 37 degrees: what falls on a steeper floor rolls off
  if (up < kFloorUp) return Material::kRock;
  return height_m < terms_->beach_m ? Material::kSand : Material::kScree;
}

Material WorldFunction::rock(const RockPlace& place) const {
  return terms_->strata->rock_at(rock_point(*terms_, place));
}

LayerPlace WorldFunction::layer(const RockPlace& place) const {
  return terms_->strata->layer_at(rock_point(*terms_, place));
}

}  // namespace talus
