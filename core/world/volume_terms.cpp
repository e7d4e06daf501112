#include <array>
#include <string>

#include "core/base/hash.hpp"
#include "core/world/terms.hpp"

namespace talus {
namespace {

/// Streams of chance of the volume, apart from those of terms.cpp.
constexpr std::uint64_t kWarpSeed = 101;
constexpr std::uint64_t kCarveSeed = 102;

/// In the order of CarveKind.
constexpr std::array<const char*, kCarvePasses> kPassNames{"notch", "caves", "alcoves", "arches"};

CarvePass pass_of(const Manifest& manifest, const std::string& name) {
  const auto number = [&](const char* key) { return parameter(manifest, name + "." + key); };
  const auto real = [&](const char* key) { return static_cast<float>(number(key)); };
  const auto whole = [&](const char* key) { return static_cast<int>(number(key)); };
  CarvePass pass;
  pass.cell_m = number("cell_m");
  pass.probability = real("probability");
  pass.slope_min = real("slope_min");
  pass.elevation_low_m = real("elevation_low_m");
  pass.elevation_high_m = real("elevation_high_m");
  pass.radius_low_m = real("radius_low_m");
  pass.radius_high_m = real("radius_high_m");
  pass.stretch = real("stretch");
  pass.jitter = real("jitter");
  pass.roof_m = real("roof_m");
  if (name == "arches") return pass;
  pass.steps_low = whole("steps_low");
  pass.steps_high = whole("steps_high");
  pass.spheres_low = whole("spheres_low");
  pass.spheres_high = whole("spheres_high");
  pass.step_m = real("step_m");
  pass.fall = real("fall");
  pass.end_radius = real("end_radius");
  return pass;
}

}  // namespace

WarpControls warp_of(const Manifest& manifest) {
  const auto real = [&](const char* key) { return static_cast<float>(parameter(manifest, key)); };
  return {real("warp.reach_m"), real("warp.slope_low"), real("warp.slope_high"), parameter(manifest, "warp.patch_m"),
          mix64(manifest.seed, kWarpSeed)};
}

CarveControls carve_of(const Manifest& manifest) {
  const auto real = [&](const char* key) { return static_cast<float>(parameter(manifest, key)); };
  CarveControls c;
  for (std::size_t n = 0; n < kCarvePasses; ++n) c.passes[n] = pass_of(manifest, kPassNames[n]);
  c.arch_span_m = real("arches.span_m");
  c.union_m = real("carve.union_m");
  c.blend_m = real("carve.blend_m");
  c.roughness_m = real("carve.roughness_m");
  c.seed = mix64(manifest.seed, kCarveSeed);
  return c;
}

void volume_faults(const Manifest& manifest, std::vector<ManifestFault>& faults) {
  const auto in_order = [&](const std::string& low, const std::string& high) {
    if (parameter(manifest, low) > parameter(manifest, high)) faults.push_back({low, "is above " + high});
  };
  if (parameter(manifest, "warp.slope_low") >= parameter(manifest, "warp.slope_high"))
    faults.push_back({"warp.slope_low", "is not below warp.slope_high"});
  for (const std::string name : kPassNames) {
    in_order(name + ".elevation_low_m", name + ".elevation_high_m");
    in_order(name + ".radius_low_m", name + ".radius_high_m");
    if (name == kPassNames[static_cast<std::size_t>(CarveKind::kArches)]) continue;
    in_order(name + ".steps_low", name + ".steps_high");
    in_order(name + ".spheres_low", name + ".spheres_high");
  }
  if (!faults.empty()) return;
  const CarveControls controls = carve_of(manifest);
  for (std::size_t n = 0; n < kCarvePasses; ++n) {
    if (carve_reach_m(controls, static_cast<CarveKind>(n)) <= kCarveReach_m) continue;
    const std::string name = kPassNames[n];
    const bool is_arch = static_cast<CarveKind>(n) == CarveKind::kArches;
    faults.push_back(
        {name + (is_arch ? ".span_m" : ".steps_high"),
         "makes " + name + " reach further than 88 m from their seed: take fewer or shorter steps, or less radius"});
  }
}

double carve_reach_m(const CarveControls& controls, CarveKind kind) {
  const CarvePass& pass = controls.pass(kind);
  const auto radius_m = static_cast<double>(pass.radius_high_m);
  const auto jitter_m = static_cast<double>(pass.jitter) * radius_m;
  const auto band_m = static_cast<double>(kCarveBand_m);
  // An arch's way, the third of a radius behind it, its flare; or the steps, with a last radius that may be larger.
  if (kind == CarveKind::kArches)
    return static_cast<double>(controls.arch_span_m) + 1.42 * radius_m + 0.5 * jitter_m + band_m;
  const double end = pass.end_radius > 1.0f ? static_cast<double>(pass.end_radius) : 1.0;
  return (pass.steps_high - 1) * static_cast<double>(pass.step_m) + end * (radius_m + 1.42 * jitter_m) + band_m;
}

}  // namespace talus
