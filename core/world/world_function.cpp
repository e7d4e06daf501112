#include "core/world/world_function.hpp"

#include <utility>

#include "core/base/check.hpp"
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

}  // namespace talus
