// A world, as data: every number the terrain depends on, with its unit, limits and meaning.
//
// A manifest and a point decide the terrain; nothing else does. Two servers with equal canonical bytes serve equal
// chunks, so the hash of those bytes names the world, its caches and its payloads. Pure; reading TOML is
// protocol/manifest_toml.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Raised by every change that moves one bit of any chunk of any world.
inline constexpr std::uint32_t kGeneratorVersion = 5;
inline constexpr std::size_t kWorldNameMax = 32;  ///< bytes of [a-z0-9_-]

struct Manifest {
  std::string name = "default";  ///< 1..kWorldNameMax of [a-z0-9_-]; names the world in URLs
  std::uint64_t seed = 20261466;
  /// One value per entry of manifest_parameters(), in its order; starts as the defaults.
  std::vector<double> values;

  Manifest();
  friend bool operator==(const Manifest&, const Manifest&) = default;
};

struct ParameterInfo {
  std::string_view name;     ///< `section.key`, as in the TOML file; ends in its unit where it has one
  std::string_view unit;     ///< "m", "", "1/m" ...
  double low = 0;            ///< smallest value allowed
  double high = 0;           ///< largest value allowed
  double initial = 0;        ///< default
  bool whole = false;        ///< only whole numbers
  std::string_view meaning;  ///< one sentence: what it is, and what more and less of it do
};

/// Every parameter, in canonical order. The index of an entry is its index in Manifest::values.
std::span<const ParameterInfo> manifest_parameters();
/// Index of the parameter called `name`, or manifest_parameters().size() if there is none.
std::size_t parameter_index(std::string_view name);
/// Value of the parameter called `name`. Programmer error if there is none.
double parameter(const Manifest& manifest, std::string_view name);

/// Why a manifest cannot be: the parameter (or "name") at fault and a sentence. Empty when it can.
struct ManifestFault {
  std::string parameter;
  std::string message;
};
/// Limits of each value and the contradictions between them, in order of the table.
std::vector<ManifestFault> manifest_faults(const Manifest& manifest);

/// The bytes that are hashed: generator version, name, seed, then name and IEEE bits of every parameter, little-endian.
std::vector<std::byte> canonical_bytes(const Manifest& manifest);

}  // namespace talus
