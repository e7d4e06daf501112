// talus gallery: what single parameters do, side by side.
#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/lettering.hpp"
#include "client_sample/cli/map_picture.hpp"

namespace talus::cli {
namespace {

/// One picture of an exhibit.
struct Frame {
  std::string label;
  MapArea area;
  Manifest manifest;
};

struct Exhibit {
  std::string_view file;
  std::string_view what;
  std::vector<Frame> frames;  ///< from left to right
};

/// A high range of the default world, and one flank of it.
constexpr MapArea kRange{{78'000, -57'000}, 6000};
constexpr MapArea kFlank{{79'500, -58'500}, 2500};

/// One parameter at some values, over one square of the default world. Snow is put away: it hides forms.
Exhibit one_parameter(std::string_view file, std::string_view name, const std::vector<double>& values,
                      const MapArea& area) {
  Exhibit out{file, name, {}};
  for (const double value : values) {
    Frame frame{fmt::format("{}", value), area, {}};
    frame.manifest.values[parameter_index("cover.snow_line_m")] = 4500;
    frame.manifest.values[parameter_index("cover.grass_line_m")] = 1500;
    frame.manifest.values[parameter_index(name)] = value;
    out.frames.push_back(std::move(frame));
  }
  return out;
}

Exhibit scales() {
  Exhibit out{"scales", "one place from 256 km down to 4 km", {}};
  for (const double edge_km : {256.0, 64.0, 16.0, 4.0}) {
    out.frames.push_back({fmt::format("{} km", edge_km), {kRange.centre_m, edge_km * 1000}, {}});
  }
  return out;
}

std::vector<Exhibit> exhibits() {
  return {
      scales(),
      one_parameter("octaves", "erosion.octaves", {0, 2, 7}, kRange),
      one_parameter("stacked_fading", "erosion.detail", {0.4, 1.8, 5}, kRange),
      one_parameter("normalised_gullies", "erosion.normalisation", {0, 0.5, 0.9}, kRange),
      one_parameter("gully_weight", "erosion.gully_weight", {0.1, 0.5, 1}, kRange),
      one_parameter("branching", "erosion.assumed_slope", {0.1, 0.7, 3}, kRange),
      one_parameter("rounding_of_ridges", "erosion.rounding_ridge", {0, 0.2, 0.8}, kFlank),
      one_parameter("rounding_of_creases", "erosion.rounding_crease", {0, 0.2, 0.8}, kFlank),
      one_parameter("differential_erosion", "strata.ledge", {0, 0.9, 1.8}, kFlank),
  };
}

constexpr int kGap = 6;

void paste(const Picture& from, Picture& to, int x) {
  const auto bytes = static_cast<std::ptrdiff_t>(from.width) * 3;
  for (int k = 0; k < from.height; ++k) {
    const auto target = (static_cast<std::ptrdiff_t>(k) * to.width + x) * 3;
    std::copy_n(from.rgb.begin() + k * bytes, bytes, to.rgb.begin() + target);
  }
}

}  // namespace

ExitCode gallery(const GalleryOptions& options) {
  for (const Exhibit& exhibit : exhibits()) {
    const int count = static_cast<int>(exhibit.frames.size());
    Picture all{count * options.size + (count - 1) * kGap, options.size, {}};
    all.rgb.assign(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height) * 3, 255);
    for (int n = 0; n < count; ++n) {
      const Frame& frame = exhibit.frames[static_cast<std::size_t>(n)];
      const WorldFunction world(frame.manifest);
      Picture picture = draw_picture(world, frame.area, options.size, {});
      write_text(picture, 8, 8, frame.label);
      paste(picture, all, n * (options.size + kGap));
    }
    if (!store_picture(fmt::format("{}/{}.png", options.folder, exhibit.file), all)) return kFailed;
    fmt::print("{}.png: {}\n", exhibit.file, exhibit.what);
  }
  return kDone;
}

}  // namespace talus::cli
