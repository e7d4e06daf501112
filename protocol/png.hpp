// Pictures as PNG files. Pure; no libpng type leaves the source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace talus::protocol {

/// Most pixels along either side of a picture.
inline constexpr int kPictureEdgeMax = 16384;

/// `rgb` is 3 * width * height bytes, sRGB, rows from top to bottom; width and height are 1..kPictureEdgeMax.
std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace talus::protocol
