// talus gallery: what single parameters do, side by side.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "client_sample/cli/block_picture.hpp"
#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/lettering.hpp"
#include "client_sample/cli/map_picture.hpp"

namespace talus::cli {
namespace {

/// One picture of an exhibit: a square from above, or a cliff from the sea.
struct Frame {
  std::string label;
  std::variant<MapArea, BlockView> view;
  Manifest manifest;
  MapLayer layer = MapLayer::kShaded;  ///< of a square from above
};

struct Exhibit {
  std::string_view file;
  std::string_view what;
  std::vector<Frame> frames;  ///< from left to right
};

/// A high range of the default world, and one flank of it; a headland with arches, and the foot of a cliff.
constexpr MapArea kRange{{78'000, -57'000}, 6000};
constexpr MapArea kFlank{{79'500, -58'500}, 2500};
/// A bare flank whose beds one can count.
constexpr MapArea kBenches{{77'300, -57'000}, 700};
/// Gullies through folded beds.
constexpr MapArea kGorge{{75'264, -59'904}, 1200};
constexpr BlockView kHeadland{{4845, 24, 39'280}, 200, -12, 110};
/// A cliff of soft beds under a hard one.
constexpr BlockView kHangingBed{{5738, 40, 30'112}, 0, -15, 200};

using Settings = std::vector<std::pair<std::string_view, double>>;

Frame frame_of(std::string label, const std::variant<MapArea, BlockView>& view, const Settings& settings) {
  Frame out{std::move(label), view, {}, MapLayer::kShaded};
  // Snow is put away: it hides forms.
  out.manifest.values[parameter_index("cover.snow_line_m")] = 4500;
  out.manifest.values[parameter_index("cover.grass_line_m")] = 1500;
  for (const auto& [name, value] : settings) out.manifest.values[parameter_index(name)] = value;
  return out;
}

/// One parameter at some values, over one place of the default world.
Exhibit one_parameter(std::string_view file, std::string_view name, const std::vector<double>& values,
                      const std::variant<MapArea, BlockView>& view) {
  Exhibit out{file, name, {}};
  for (const double value : values) out.frames.push_back(frame_of(fmt::format("{}", value), view, {{name, value}}));
  return out;
}

Exhibit scales() {
  Exhibit out{"scales", "one place from 256 km down to 4 km", {}};
  for (const double edge_km : {256.0, 64.0, 16.0, 4.0}) {
    out.frames.push_back({fmt::format("{} km", edge_km), MapArea{kRange.centre_m, edge_km * 1000}, {}});
  }
  return out;
}

Exhibit differential_erosion() {
  Exhibit out{"differential_erosion", "none; strata.resistance and strata.ledge", {}};
  out.frames.push_back(frame_of("0", kBenches, {{"strata.resistance", 0}, {"strata.ledge", 0}}));
  out.frames.push_back(frame_of("1", kBenches, {}));
  // Colours of beds would hide their forms.
  for (Frame& frame : out.frames) frame.layer = MapLayer::kSlope;
  return out;
}

/// The passes of carving, one after another.
Exhibit carving() {
  Exhibit out{"carving", "no pass, notch, caves as well, arches as well", {}};
  Settings off{
      {"notch.probability", 0}, {"caves.probability", 0}, {"arches.probability", 0}, {"alcoves.probability", 0}};
  out.frames.push_back(frame_of("0", kHeadland, off));
  for (const int passes : {1, 2, 3}) {
    off.erase(off.begin());
    out.frames.push_back(frame_of(fmt::format("{}", passes), kHeadland, off));
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
      one_parameter("methods", "erosion.frequency_share", {0, 0.5, 1}, kRange),
      one_parameter("resistance", "strata.resistance", {0, 0.7, 1}, kGorge),
      differential_erosion(),
      one_parameter("warp", "warp.reach_m", {0, 4, 6}, kHeadland),
      carving(),
      one_parameter("alcoves", "alcoves.probability", {0, 0.8}, kHangingBed),
  };
}

/// Every world of a folder, in the order of their files' names; nothing if one has faults.
std::optional<Exhibit> presets(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::ranges::sort(files);
  Exhibit out{"presets", "the worlds of a folder", {}};
  for (const std::string& file : files) {
    auto manifest = load_manifest(file);
    if (!manifest) return std::nullopt;
    out.frames.push_back({"48 km", MapArea{{0, 0}, 48'000}, std::move(*manifest)});
  }
  if (!out.frames.empty()) return out;
  fmt::print(stderr, "talus: no .toml file in {}\n", folder);
  return std::nullopt;
}

Picture draw_frame(const Frame& frame, int size) {
  const WorldFunction world(frame.manifest);
  if (const auto* cliff = std::get_if<BlockView>(&frame.view)) return draw_block(world, *cliff, size, size);
  return draw_picture(world, std::get<MapArea>(frame.view), size, {frame.layer, 0});
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
  std::vector<Exhibit> all_exhibits = exhibits();
  if (!options.worlds.empty()) {
    auto worlds = presets(options.worlds);
    if (!worlds) return kFailed;
    all_exhibits.push_back(std::move(*worlds));
  }
  if (!options.only.empty()) {
    std::erase_if(all_exhibits, [&](const Exhibit& exhibit) { return exhibit.file != options.only; });
    if (all_exhibits.empty()) {
      fmt::print(stderr, "talus: there is no picture {}\n", options.only);
      return kUsage;
    }
  }
  for (const Exhibit& exhibit : all_exhibits) {
    const int count = static_cast<int>(exhibit.frames.size());
    Picture all{count * options.size + (count - 1) * kGap, options.size, {}};
    all.rgb.assign(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height) * 3, 255);
    for (int n = 0; n < count; ++n) {
      const Frame& frame = exhibit.frames[static_cast<std::size_t>(n)];
      Picture picture = draw_frame(frame, options.size);
      write_text(picture, 8, 8, frame.label);
      paste(picture, all, n * (options.size + kGap));
    }
    if (!store_picture(fmt::format("{}/{}.png", options.folder, exhibit.file), all)) return kFailed;
    fmt::print("{}.png: {}\n", exhibit.file, exhibit.what);
  }
  return kDone;
}

}  // namespace talus::cli
