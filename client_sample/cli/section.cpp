// talus section: a vertical cut through the world.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/lettering.hpp"
#include "client_sample/cli/strips.hpp"
#include "client_sample/cli/text.hpp"
#include "core/map/section.hpp"

namespace talus::cli {
namespace {

constexpr int kSectionEdgeMin = 64;  // pixels
constexpr int kSectionEdgeMax = 8192;
constexpr double kLengthMin = 10;  // metres
constexpr double kLengthMax = 1.0e6;
constexpr double kSectionPlaceMax_m = 1.0e10;
constexpr double kSectionHeightMax_m = 10'000;
constexpr int kStripColumns = 16;
/// Columns that tell how high the ground along a cut reaches.
constexpr int kProbes = 400;

std::optional<SectionView> view_of(const SectionOptions& options) {
  const auto from = parse_pair(options.from);
  const auto to = parse_pair(options.to);
  const auto is_near = [](const glm::dvec2& p) {
    return std::abs(p.x) <= kSectionPlaceMax_m && std::abs(p.y) <= kSectionPlaceMax_m;
  };
  const double length = from && to ? glm::length(*to - *from) : 0;
  if (!from || !to || !is_near(*from) || !is_near(*to) || length < kLengthMin || length > kLengthMax) {
    fmt::print(stderr, "talus: --from and --to are x,z in metres, within +-1e10 and {} m to {} km apart, as -2000,0\n",
               kLengthMin, kLengthMax / 1000);
    return std::nullopt;
  }
  const auto size = parse_size(options.size);
  if (!size || std::min(size->x, size->y) < kSectionEdgeMin || std::max(size->x, size->y) > kSectionEdgeMax) {
    fmt::print(stderr, "talus: \"{}\" is no size: WIDTHxHEIGHT, each {} to {}\n", options.size, kSectionEdgeMin,
               kSectionEdgeMax);
    return std::nullopt;
  }
  SectionView view{*from, *to, 0, 0, size->x, size->y};
  if (options.heights.empty()) return view;
  const auto heights = parse_pair(options.heights);
  if (!heights || heights->x >= heights->y || std::abs(heights->x) > kSectionHeightMax_m ||
      std::abs(heights->y) > kSectionHeightMax_m) {
    fmt::print(stderr, "talus: \"{}\" are no heights: low,high in metres within +-{}\n", options.heights,
               kSectionHeightMax_m);
    return std::nullopt;
  }
  view.low_m = heights->x;
  view.high_m = heights->y;
  return view;
}

/// Rock below the ground, sky above it, and never a picture so flat that a hill is a wall.
void fit_heights(const WorldFunction& world, SectionView& view) {
  SectionScratch scratch;
  const glm::dvec2 ground = section_heights(world, view, kProbes, scratch);
  const double low = std::min(ground.x, 0.0);
  const double high = std::max(ground.y, 0.0);
  const double square = glm::length(view.to_m - view.from_m) / view.width * view.height;
  const double span = std::max((high - low) * 1.5, square / 6);
  view.low_m = low - (span - (high - low)) * 0.6;
  view.high_m = view.low_m + span;
}

}  // namespace

ExitCode section(const SectionOptions& options) {
  auto view = view_of(options);
  if (!view) return kUsage;
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const WorldFunction world(*manifest);
  if (options.heights.empty()) fit_heights(world, *view);

  const std::size_t pixels = static_cast<std::size_t>(view->width) * static_cast<std::size_t>(view->height);
  Picture picture{view->width, view->height, std::vector<std::uint8_t>(3 * pixels)};
  std::vector<SectionScratch> scratch(static_cast<std::size_t>(strip_workers()));
  for_each_strip("section", (view->width + kStripColumns - 1) / kStripColumns, [&](int strip, int worker) {
    const int end = std::min(view->width, (strip + 1) * kStripColumns);
    for (int i = strip * kStripColumns; i < end; ++i) {
      draw_section_column(world, *view, i, scratch[static_cast<std::size_t>(worker)], picture.rgb);
    }
  });
  draw_scale_bar(picture, glm::length(view->to_m - view->from_m) / view->width);
  draw_height_marks(picture, view->low_m, view->high_m);
  return store_picture(options.output, picture) ? kDone : kFailed;
}

}  // namespace talus::cli
