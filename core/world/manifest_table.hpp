// The table of every world parameter, in canonical order: a file a theme, one after the other.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/world/manifest.hpp"
#include "core/world/parameters_cover.hpp"
#include "core/world/parameters_ground.hpp"
#include "core/world/parameters_landforms.hpp"
#include "core/world/parameters_volume.hpp"

namespace talus {

namespace detail {

template <std::size_t... kCounts>
constexpr auto joined(const std::array<ParameterInfo, kCounts>&... themes) {
  std::array<ParameterInfo, (kCounts + ...)> all{};
  auto out = all.begin();
  ((out = std::ranges::copy(themes, out).out), ...);
  return all;
}

}  // namespace detail

inline constexpr std::array kManifestTable =
    detail::joined(kGroundParameters, kLandformParameters, kVolumeParameters, kCoverParameters);

}  // namespace talus
