#include "protocol/png.hpp"

#include <png.h>

#include "core/base/check.hpp"

namespace talus::protocol {

std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgb) {
  TALUS_CHECK(width > 0 && height > 0 && width <= kPictureEdgeMax && height <= kPictureEdgeMax);
  TALUS_CHECK(rgb.size() == std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::byte> out(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t bytes = out.size();
  // Memory for zlib is all that can fail here.
  TALUS_CHECK(png_image_write_to_memory(&image, out.data(), &bytes, 0, rgb.data(), 0, nullptr) != 0);
  out.resize(bytes);
  return out;
}

}  // namespace talus::protocol
