#include "core/world/manifest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/base/check.hpp"
#include "core/grid/chunk_key.hpp"
#include "core/world/manifest_table.hpp"
#include "core/world/terms.hpp"

namespace talus {
namespace {

/// Every period is a multiple of it, so that cells whose edge is a power of two up to it fit without change.
constexpr double kWrapUnit_m = 131072;

void put(std::vector<std::byte>& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

void put(std::vector<std::byte>& out, std::string_view text) {
  put(out, text.size(), 4);
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
}

bool is_name(std::string_view name) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !name.empty() && name.size() <= kWorldNameMax && std::ranges::all_of(name, allowed);
}

bool is_power_of_two(double v) {
  int exponent = 0;
  return std::frexp(v, &exponent) == 0.5;
}

}  // namespace

Manifest::Manifest() {
  values.reserve(kManifestTable.size());
  for (const ParameterInfo& info : kManifestTable) values.push_back(info.initial);
}

std::span<const ParameterInfo> manifest_parameters() {
  return kManifestTable;
}

std::size_t parameter_index(std::string_view name) {
  const auto at = std::ranges::find(kManifestTable, name, &ParameterInfo::name);
  return static_cast<std::size_t>(at - kManifestTable.begin());
}

double parameter(const Manifest& manifest, std::string_view name) {
  const std::size_t index = parameter_index(name);
  TALUS_CHECK(index < manifest.values.size());
  return manifest.values[index];
}

std::vector<ManifestFault> manifest_faults(const Manifest& manifest) {
  std::vector<ManifestFault> faults;
  if (!is_name(manifest.name)) faults.push_back({"name", "is 1 to 32 characters of a-z, 0-9, _ and -"});
  if (manifest.values.size() != kManifestTable.size()) {
    faults.push_back({"", "has not one value per parameter"});
    return faults;
  }
  for (std::size_t i = 0; i < kManifestTable.size(); ++i) {
    const ParameterInfo& info = kManifestTable[i];
    const double value = manifest.values[i];
    if (!(value >= info.low && value <= info.high)) {
      faults.push_back({std::string(info.name), "is out of range"});
    } else if (info.whole && value != std::floor(value)) {
      faults.push_back({std::string(info.name), "is not a whole number"});
    }
  }
  if (!faults.empty()) return faults;

  if (!is_power_of_two(parameter(manifest, "chunk.voxel_m"))) {
    faults.push_back({"chunk.voxel_m", "is not a power of two, so that neighbouring lattices would not nest"});
  }
  if (!is_power_of_two(parameter(manifest, "chunk.cells"))) {
    faults.push_back({"chunk.cells", "is not a power of two, so that a chunk would not have eight children"});
  }
  const double wrap_m = parameter(manifest, "world.wrap_m");
  const double coarsest_chunk_m =
      parameter(manifest, "chunk.cells") * parameter(manifest, "chunk.voxel_m") * (1 << kLodMax);
  if (std::fmod(wrap_m, std::max(coarsest_chunk_m, kWrapUnit_m)) != 0) {
    faults.push_back({"world.wrap_m", "is not a whole number of 131072 m and of chunks of the coarsest LOD"});
  }
  if (std::fmod(wrap_m, 4 * parameter(manifest, "plates.size_m")) != 0) {
    faults.push_back({"world.wrap_m", "is not a whole number of groups of plates, 4 * plates.size_m"});
  }
  if (parameter(manifest, "macro.sea_floor_m") >= -parameter(manifest, "macro.shelf_depth_m")) {
    faults.push_back({"macro.sea_floor_m", "is not below the shelf's edge, -macro.shelf_depth_m"});
  }
  volume_faults(manifest, faults);
  return faults;
}

std::vector<std::byte> canonical_bytes(const Manifest& manifest) {
  std::vector<std::byte> out;
  put(out, "talus world");
  put(out, kGeneratorVersion, 4);
  put(out, manifest.name);
  put(out, manifest.seed, 8);
  put(out, kManifestTable.size(), 4);
  for (std::size_t i = 0; i < kManifestTable.size(); ++i) {
    put(out, kManifestTable[i].name);
    // + 0.0 makes one zero of the two.
    put(out, std::bit_cast<std::uint64_t>(manifest.values[i] + 0.0), 8);
  }
  return out;
}

}  // namespace talus
