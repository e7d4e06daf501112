#include "core/world/world_function.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/grid/wrap.hpp"
#include "core/world/terms.hpp"

namespace talus {
WorldFunction::WorldFunction(Manifest manifest) {
  TALUS_CHECK(manifest_faults(manifest).empty());
  terms_ = std::make_unique<const Terms>(terms_of(std::move(manifest)));
}
WorldFunction::~WorldFunction() = default;

const Manifest& WorldFunction::manifest() const {
  return terms_->manifest;
}
int WorldFunction::cells() const {
  return terms_->cells;
}
double WorldFunction::voxel_m() const {
  return terms_->voxel_m;
}
glm::dvec2 WorldFunction::height_range_m() const {
  return {static_cast<double>(terms_->low_m), static_cast<double>(terms_->high_m)};
}

PlatePlace WorldFunction::plate_at(const glm::dvec2& place_m, ColumnWorkspace& workspace) const {
  return place_at(terms_->macro->plates(), place_m, workspace.macro.plates);
}

DistrictShares ColumnBlock::districts_at(std::size_t index) const {
  DistrictShares out;
  for (std::size_t k = 0; k < kDistricts; ++k) out[k] = district[k][index];
  return out;
}

Material WorldFunction::cover(float height_m, float up, float ridge, float hilliness, glm::i64vec2 column_voxel,
                              const DistrictShares& districts) const {
  const Terms& t = *terms_;
  column_voxel.x = wrapped(column_voxel.x, t.wrap_voxel);
  // A dither per column breaks the lines along which altitude and slope change the cover.
  const std::uint64_t hash = mix64(mix64(t.manifest.seed, static_cast<std::uint64_t>(column_voxel.x)),
                                   static_cast<std::uint64_t>(column_voxel.y));
  const float dither = static_cast<float>(hash >> 40) * 0x1p-24f - 0.5f;
  const float cosine = std::max(up, 0.05f);
  const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
  const float steep = slope + 0.12f * dither;

  const float dry = districts[0] + districts[2];
  const float rock_slope = t.rock_slope * (1.0f - 0.55f * dry);

  if (height_m < t.beach_m + 1.5f * dither && steep < 0.35f) return Material::kSand;
  if (height_m < -1.0f) return steep < t.rock_slope ? Material::kSand : Material::kRock;
  if (districts[1] + 0.25f * dither > 0.45f && steep < t.rock_slope) return Material::kSand;
  if (steep > rock_slope) return Material::kRock;
  if (height_m + 160.0f * dither - 220.0f * (slope - 0.4f) > t.snow_line_m) return Material::kSnow;
  if (ridge < -0.72f && hilliness > 0.15f && slope > 0.12f) return Material::kStreamBed;
  if (height_m + 120.0f * dither > t.grass_line_m) return steep > 0.45f ? Material::kScree : Material::kSoil;
  if (dry + 0.5f * dither > 0.5f) return steep > 0.6f * rock_slope ? Material::kScree : Material::kSoil;
  if (steep > 0.72f * rock_slope) return ridge > 0.1f ? Material::kSoil : Material::kScree;
  return Material::kGrass;
}

Material WorldFunction::sheltered(float height_m, float up) const {
  constexpr float kFloorUp = 0.8f;  // about 37 degrees: what falls on a steeper floor rolls off
  if (up < kFloorUp) return Material::kRock;
  return height_m < terms_->beach_m ? Material::kSand : Material::kScree;
}

Material WorldFunction::rock(float stack_m, float choice, float height_m, glm::i64vec2 column_voxel) const {
  column_voxel.x = wrapped(column_voxel.x, terms_->wrap_voxel);
  const glm::dvec2 place_m = glm::dvec2(column_voxel) * terms_->voxel_m;
  return terms_->strata->rock_at(stack_m, choice, height_m, place_m);
}

LayerPlace WorldFunction::layer(float stack_m, float choice, float height_m, glm::i64vec2 column_voxel) const {
  column_voxel.x = wrapped(column_voxel.x, terms_->wrap_voxel);
  const glm::dvec2 place_m = glm::dvec2(column_voxel) * terms_->voxel_m;
  return terms_->strata->layer_at(stack_m, choice, height_m, place_m);
}

}  // namespace talus
