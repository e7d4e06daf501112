// talus map: a picture of the world from above.
#include <cmath>

#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/map_picture.hpp"
#include "client_sample/cli/text.hpp"
#include "protocol/png.hpp"

namespace talus::cli {
namespace {

/// Edges of maps, in km: some voxels, and a tenth of the way round the Earth.
constexpr double kEdgeKmMin = 0.05;
constexpr double kEdgeKmMax = 4000.0;
/// A map's centre reaches +-this, in metres: chunk coordinates do, and pixels beyond the edge stay exact.
constexpr double kCentreMax = 1.0e10;

}  // namespace

std::optional<MapArea> area_of(const std::string& text) {
  const auto numbers = parse_place(text);
  if (!numbers || std::abs(numbers->x) > kCentreMax || std::abs(numbers->y) > kCentreMax || numbers->z < kEdgeKmMin ||
      numbers->z > kEdgeKmMax) {
    fmt::print(stderr,
               "talus: \"{}\" is no area: give the centre's x and z in metres (each within +-1e10) and the edge in km "
               "({} to {}), as 0,0,64\n",
               text, kEdgeKmMin, kEdgeKmMax);
    return std::nullopt;
  }
  return MapArea{{numbers->x, numbers->y}, numbers->z * 1000.0};
}

bool store_picture(const std::string& path, const Picture& picture) {
  const std::vector<std::byte> png = protocol::encode_png(picture.width, picture.height, picture.rgb);
  return store_file(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

ExitCode map(const MapOptions& options) {
  const auto area = area_of(options.area);
  const auto layer = map_layer(options.layer);
  if (!area || !layer) return kUsage;
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const WorldFunction world(*manifest);
  const Picture picture = draw_picture(world, *area, options.size, {*layer, options.contour_m});
  return store_picture(options.output, picture) ? kDone : kFailed;
}

}  // namespace talus::cli
