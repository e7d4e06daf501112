#include "protocol/png.hpp"

#include <png.h>

#include <gtest/gtest.h>

namespace talus::protocol {
namespace {

TEST(Png, GivesItsPixelsBackToAnyReader) {
  const int width = 7;
  const int height = 5;
  std::vector<std::uint8_t> rgb(std::size_t{3} * width * height);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 37);
  const std::vector<std::byte> bytes = encode_png(width, height, rgb);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  EXPECT_EQ(image.width, 7U);
  EXPECT_EQ(image.height, 5U);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(rgb.size());
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(read, rgb);
  EXPECT_EQ(encode_png(width, height, rgb), bytes);
}

}  // namespace
}  // namespace talus::protocol
