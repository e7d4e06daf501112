// The manifest as the kernels want it: floats and noises instead of names. Private to core/world.
#pragma once

#include <memory>

#include "core/erosion/filter.hpp"
#include "core/landforms/coast.hpp"
#include "core/landforms/cones.hpp"
#include "core/landforms/detail.hpp"
#include "core/landforms/district.hpp"
#include "core/landforms/dunes.hpp"
#include "core/landforms/karst.hpp"
#include "core/landforms/tables.hpp"
#include "core/noise/gradient_noise.hpp"
#include "core/plates/macro_field.hpp"
#include "core/strata/hardness_profile.hpp"
#include "core/strata/strata.hpp"
#include "core/strata/terraces.hpp"
#include "core/volume/controls.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Hills, and how erosion meets them; heights in metres.
struct ReliefTerms {
  float hill_base_m, hill_high_m;  ///< amplitude of hills at hilliness 0, and added at 1
  float fade_altitude, fade_relief, plain_strength, hill_strength;
};

struct WorldFunction::Terms {
  Manifest manifest;
  int cells = 32;
  double voxel_m = 1;
  std::int64_t wrap_voxel = 0;  ///< east-west period, 0 for none
  std::unique_ptr<const MacroField> macro;
  ReliefTerms relief{};
  FractalNoise hills, fold, tilt, set_choice, district;
  ErosionControls erosion;
  float frequency_share = 0;
  CoastControls coast;
  ConeControls cones;
  DetailControls detail;
  std::unique_ptr<const Strata> strata;
  std::unique_ptr<const Terraces> terraces;
  DistrictControls districts;
  BadlandsControls badlands;
  MesaControls mesas;
  DuneControls dunes;
  KarstControls karst;
  ErosionControls rills;  ///< fine gullies of badlands, table land and karst
  std::unique_ptr<const HardnessProfile> profile;
  WarpControls warp;
  CarveControls carve;
  std::uint64_t identity = 0;  ///< of the whole manifest
  float fold_m = 0, tilt_m = 0, resistance = 0;
  float low_m = 0, high_m = 0;  ///< heights of surfaces never leave this
  float snow_line_m = 0, grass_line_m = 0, beach_m = 0, rock_slope = 0;
};

WarpControls warp_of(const Manifest& manifest);
CarveControls carve_of(const Manifest& manifest);
/// Contradictions between parameters of the volume, each of which is within its limits.
void volume_faults(const Manifest& manifest, std::vector<ManifestFault>& faults);
/// Horizontal distance from a seed of this pass to the furthest point that can feel it, in metres.
double carve_reach_m(const CarveControls& controls, CarveKind kind);

/// Requires manifest_faults(manifest) to be empty.
WorldFunction::Terms terms_of(Manifest manifest);

}  // namespace talus
