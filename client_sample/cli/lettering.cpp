#include "client_sample/cli/lettering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

namespace talus::cli {
namespace {

constexpr int kLetterColumns = 5;
constexpr int kLetterRows = 7;
constexpr int kAdvance = kLetterColumns + 1;
constexpr std::string_view kLetters = "0123456789.-km";
/// A row a byte, the leftmost pixel the highest of five bits.
constexpr std::array<std::array<std::uint8_t, kLetterRows>, kLetters.size()> kRows{{
    {14, 17, 19, 21, 25, 17, 14},
    {4, 12, 4, 4, 4, 4, 14},
    {14, 17, 1, 2, 4, 8, 31},
    {31, 2, 4, 2, 1, 17, 14},
    {2, 6, 10, 18, 31, 2, 2},
    {31, 16, 30, 1, 1, 17, 14},
    {6, 8, 16, 30, 17, 17, 14},
    {31, 1, 2, 4, 8, 8, 8},
    {14, 17, 17, 14, 17, 17, 14},
    {14, 17, 17, 15, 1, 2, 12},
    {0, 0, 0, 0, 0, 12, 12},
    {0, 0, 0, 31, 0, 0, 0},
    {16, 16, 18, 20, 24, 20, 18},
    {0, 0, 26, 21, 21, 21, 21},
}};

void set_pixel(Picture& picture, int x, int y, std::uint8_t grey) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const auto at =
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x)) * 3;
  std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(at), 3, grey);
}

void fill(Picture& picture, int x, int y, int width, int height, std::uint8_t grey) {
  for (int k = y; k < y + height; ++k) {
    for (int i = x; i < x + width; ++i) set_pixel(picture, i, k, grey);
  }
}

/// The pixels of a text, given to `set(x, y)`.
template <typename Set>
void letter_pixels(int x, int y, std::string_view text, Set set) {
  for (const char c : text) {
    const std::size_t letter = kLetters.find(c);
    for (int row = 0; letter != std::string_view::npos && row < kLetterRows; ++row) {
      for (int column = 0; column < kLetterColumns; ++column) {
        const bool is_set = (kRows[letter][static_cast<std::size_t>(row)] >> (kLetterColumns - 1 - column) & 1) != 0;
        if (is_set) set(x + column, y + row);
      }
    }
    x += kAdvance;
  }
}

/// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= length) return factor * power;
  }
  return power;
}

std::string length_text(double metres) {
  return metres >= 1000 ? fmt::format("{} km", metres / 1000) : fmt::format("{} m", metres);
}

}  // namespace

void write_text(Picture& picture, int x, int y, std::string_view text) {
  letter_pixels(x, y, text, [&](int i, int k) { fill(picture, i - 1, k - 1, 3, 3, 30); });
  letter_pixels(x, y, text, [&](int i, int k) { set_pixel(picture, i, k, 250); });
}

void draw_scale_bar(Picture& picture, double pixel_m) {
  const double length = round_length(picture.width * pixel_m / 5);
  const int pixels = static_cast<int>(std::lround(length / pixel_m));
  const int x = 14;
  const int y = picture.height - 16;
  fill(picture, x - 1, y - 1, pixels + 2, 5, 30);
  fill(picture, x, y, pixels, 3, 250);
  write_text(picture, x, y - 12, length_text(length));
}

void draw_height_marks(Picture& picture, double low_m, double high_m) {
  const double interval = round_length((high_m - low_m) / 4);
  const double pixel_m = (high_m - low_m) / picture.height;
  for (auto mark = std::lround(std::ceil(low_m / interval)); static_cast<double>(mark) * interval < high_m; ++mark) {
    const double at = static_cast<double>(mark) * interval;
    const int y = static_cast<int>((high_m - at) / pixel_m);
    fill(picture, picture.width - 13, y - 1, 13, 3, 30);
    fill(picture, picture.width - 12, y, 12, 1, 250);
    const std::string text = fmt::format("{} m", std::lround(at));
    write_text(picture, picture.width - 18 - kAdvance * static_cast<int>(text.size()), y - 3, text);
  }
}

}  // namespace talus::cli
