// The order in which a walk down the octree meets chunks, depth first, children in the order of `children_of`: leaves
// come out of such a walk sorted, so sets of them merge without being sorted again. Pure.
//
// Lowest corners are compared along a Z curve (G. M. Morton, "A computer oriented geodetic data base and a new
// technique in file sequencing", IBM 1966): what decides is the axis whose coordinates differ in the highest bit, z
// before y before x. Of two chunks with one corner the coarser comes first.
#pragma once

#include <bit>
#include <cstdint>

#include "core/grid/chunk_key.hpp"

namespace talus {

/// A strict total order of valid keys of all LODs.
constexpr bool is_before_in_octree(const ChunkKey& a, const ChunkKey& b) {
  // Corners in LOD 0 chunks, shifted so that negative ones stay below positive ones: |c| < 2^30 * 2^12.
  const auto corner = [](std::int32_t c, std::int32_t lod) {
    return (static_cast<std::uint64_t>(static_cast<std::int64_t>(c)) << lod) + (std::uint64_t{1} << 62);
  };
  const std::uint64_t ax = corner(a.x, a.lod);
  const std::uint64_t ay = corner(a.y, a.lod);
  const std::uint64_t az = corner(a.z, a.lod);
  const std::uint64_t bx = corner(b.x, b.lod);
  const std::uint64_t by = corner(b.y, b.lod);
  const std::uint64_t bz = corner(b.z, b.lod);
  const std::uint64_t differing = (ax ^ bx) | (ay ^ by) | (az ^ bz);
  if (differing == 0) return a.lod > b.lod;
  const std::uint64_t highest = std::bit_floor(differing);
  if (((az ^ bz) & highest) != 0) return az < bz;
  if (((ay ^ by) & highest) != 0) return ay < by;
  return ax < bx;
}

}  // namespace talus
