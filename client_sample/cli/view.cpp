// talus view: a cliff as it is, drawn from the world itself.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "client_sample/cli/block_picture.hpp"
#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/text.hpp"

namespace talus::cli {
namespace {

constexpr int kViewEdgeMin = 16;  // pixels
constexpr int kViewEdgeMax = 4096;
constexpr double kViewPlaceMax_m = 1.0e9;
constexpr double kViewHeightMax_m = 8000;

}  // namespace

ExitCode view(const ViewOptions& options) {
  const auto at = parse_place(options.at);
  if (!at || std::abs(at->x) > kViewPlaceMax_m || std::abs(at->z) > kViewPlaceMax_m ||
      std::abs(at->y) > kViewHeightMax_m) {
    fmt::print(stderr, "talus: --at is x,y,z in metres, x and z within +-1e9, y within +-{}, as 4830,20,39285\n",
               kViewHeightMax_m);
    return kUsage;
  }
  const auto size = parse_size(options.size);
  if (!size || std::min(size->x, size->y) < kViewEdgeMin || std::max(size->x, size->y) > kViewEdgeMax) {
    fmt::print(stderr, "talus: \"{}\" is no size: WIDTHxHEIGHT, each {} to {}\n", options.size, kViewEdgeMin,
               kViewEdgeMax);
    return kUsage;
  }
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const WorldFunction world(*manifest);
  const BlockView block{*at, options.yaw, options.pitch, options.width_m};
  return store_picture(options.output, draw_block(world, block, size->x, size->y)) ? kDone : kFailed;
}

}  // namespace talus::cli
