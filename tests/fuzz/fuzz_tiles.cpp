#include <algorithm>

#include "core/base/check.hpp"
#include "protocol/tile_codec.hpp"
#include "tests/fuzz/fuzz_one.hpp"

int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::protocol;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  // What was let in can be sent on, and means the same then.
  if (const auto height = decode_height(bytes)) {
    const auto again = decode_height(*encode_height(height->tile, height->key));
    TALUS_CHECK(again.has_value() && again->key == height->key && again->tile.heights == height->tile.heights &&
                again->tile.ridges == height->tile.ridges && again->tile.materials == height->tile.materials);
  }
  if (const auto density = decode_density(bytes)) {
    const auto held = [](int d) { return d >= -talus::kDensityHeld && d < talus::kDensityHeld; };
    TALUS_CHECK(std::ranges::all_of(density->tile.densities, held));
    const auto again = decode_density(*encode_density(density->tile, density->key));
    TALUS_CHECK(again.has_value() && again->key == density->key && again->tile.densities == density->tile.densities &&
                again->tile.materials == density->tile.materials);
  }
  return 0;
}
