// A scale bar and height marks on a picture, in letters of five by seven pixels. Pure.
#pragma once

#include <string_view>

#include "client_sample/cli/map_picture.hpp"

namespace talus::cli {

/// Writes digits, '.', '-', 'k', 'm' and blanks, white on a dark edge, its upper left corner at (x, y).
void write_text(Picture& picture, int x, int y, std::string_view text);

/// A bar of a round length near a fifth of the picture's width, with that length beside it, in the lower left corner.
void draw_scale_bar(Picture& picture, double pixel_m);

/// Ticks along the right edge at round heights, with their figures.
void draw_height_marks(Picture& picture, double low_m, double high_m);

}  // namespace talus::cli
