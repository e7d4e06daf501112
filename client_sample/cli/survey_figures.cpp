#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include "client_sample/cli/strips.hpp"
#include "client_sample/cli/survey.hpp"

#include "core/base/hash.hpp"

namespace talus::cli {
namespace {

constexpr int kSurveyEdge = 1024;
constexpr int kTileColumns = 128;  // columns a strip evaluates at a time
/// Creases of the ridge map below this carry water.
constexpr float kStream = -0.6f;

double percentile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

void heights(const SurveyGrid& grid, SurveyFigures& out) {
  constexpr std::array kShares{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
  std::vector<float> sorted = grid.height_m;
  for (std::size_t i = 0; i < kShares.size(); ++i) out.height_percentiles_m[i] = percentile(sorted, kShares[i]);
  const auto [low, high] = std::ranges::minmax(grid.height_m);
  // Bins of whole tens of metres, with a border at the sea: no bin is both land and sea.
  out.bin_m = std::ceil(static_cast<double>(high - low) / (kHypsometricBins - 2) / 10) * 10;
  out.bin_low_m = std::floor(static_cast<double>(low) / out.bin_m) * out.bin_m;
  const double one = 1.0 / static_cast<double>(grid.height_m.size());
  for (const float height : grid.height_m) {
    const auto bin = static_cast<int>((static_cast<double>(height) - out.bin_low_m) / out.bin_m);
    out.bin_shares[static_cast<std::size_t>(std::clamp(bin, 0, kHypsometricBins - 1))] += one;
    if (height >= 0) out.land_share += one;
  }
  double sea_most = -1;
  double land_most = -1;
  for (int bin = 0; bin < kHypsometricBins; ++bin) {
    const double middle = out.bin_low_m + (bin + 0.5) * out.bin_m;
    const double share = out.bin_shares[static_cast<std::size_t>(bin)];
    double& most = middle < 0 ? sea_most : land_most;
    if (share <= most) continue;
    most = share;
    (middle < 0 ? out.sea_mode_m : out.land_mode_m) = middle;
  }
}

void slopes_and_streams(const SurveyGrid& grid, SurveyFigures& out) {
  std::vector<float> slopes;
  std::size_t land = 0;
  std::size_t streams = 0;
  const auto span = static_cast<float>(2 * grid.spacing_m);
  for (int k = 1; k + 1 < grid.edge; ++k) {
    for (int i = 1; i + 1 < grid.edge; ++i) {
      if (grid.height(i, k) < 0) continue;
      ++land;
      slopes.push_back(
          std::hypot(grid.height(i + 1, k) - grid.height(i - 1, k), grid.height(i, k + 1) - grid.height(i, k - 1)) /
          span);
      if (grid.ridge[grid.index(i, k)] < kStream) ++streams;
    }
  }
  out.slope_percentiles = {percentile(slopes, 0.5), percentile(slopes, 0.9), percentile(slopes, 0.99)};
  const double land_km2 = static_cast<double>(land) * grid.spacing_m * grid.spacing_m * 1e-6;
  if (land > 0) out.drainage_km_per_km2 = static_cast<double>(streams) * grid.spacing_m * 1e-3 / land_km2;
}

/// Boxes of `size` columns that hold both land and sea.
double mixed_boxes(const SurveyGrid& grid, int size) {
  int count = 0;
  for (int k = 0; k + size < grid.edge; k += size) {
    for (int i = 0; i + size < grid.edge; i += size) {
      bool land = false;
      bool sea = false;
      for (int dk = 0; dk <= size && !(land && sea); ++dk) {
        for (int di = 0; di <= size; ++di) (grid.height(i + di, k + dk) < 0 ? sea : land) = true;
      }
      count += land && sea ? 1 : 0;
    }
  }
  return count;
}

/// Least squares of log count over log size (box counting; B. Mandelbrot, "How long is the coast of Britain?", 1967).
void coast(const SurveyGrid& grid, SurveyFigures& out) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int size = 1; size <= 32; size *= 2) {
    const double count = mixed_boxes(grid, size);
    if (size == 1) out.coast_km = count * grid.spacing_m * 1e-3;
    if (count <= 0) return;
    const double x = std::log(size);
    const double y = std::log(count);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  out.coast_dimension = -(n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// `probes` columns of land, and as many of the shore, looked at in full.
void overhangs(const WorldFunction& world, const SurveyGrid& grid, int probes, SurveyFigures& out) {
  std::vector<glm::ivec2> land;
  std::vector<glm::ivec2> shore;
  for (int k = 1; k + 1 < grid.edge; ++k) {
    for (int i = 1; i + 1 < grid.edge; ++i) {
      if (grid.height(i, k) < 0) continue;
      land.emplace_back(i, k);
      if (grid.height(i - 1, k) < 0 || grid.height(i + 1, k) < 0 || grid.height(i, k - 1) < 0 ||
          grid.height(i, k + 1) < 0) {
        shore.emplace_back(i, k);
      }
    }
  }
  DensityBrick brick;
  const auto share = [&](const std::vector<glm::ivec2>& from, std::uint64_t use) {
    if (from.empty()) return 0.0;
    int found = 0;
    for (int p = 0; p < probes; ++p) {
      const std::uint64_t bits = mix64(mix64(use, world.manifest().seed), static_cast<std::uint64_t>(p));
      const glm::ivec2 at = from[bits % from.size()];
      const glm::dvec2 jitter{static_cast<double>(bits >> 40 & 0xFFF) / 4096, static_cast<double>(bits >> 52) / 4096};
      found += overhang_at(world, grid.place_m(at.x, at.y) + jitter * grid.spacing_m, brick).is_there ? 1 : 0;
    }
    return static_cast<double>(found) / probes;
  };
  out.overhang_share = share(land, 1);
  // A strip one spacing wide along the shore holds spacing_m columns of a metre for every metre of it.
  out.coast_overhangs_per_km = share(shore, 2) * grid.spacing_m * 1000;
}

}  // namespace

SurveyGrid survey_grid(const WorldFunction& world, const MapArea& area) {
  std::int64_t step = 1;
  while (static_cast<double>(step) * world.voxel_m() * kSurveyEdge * 1.4 < area.edge_m) step *= 2;
  SurveyGrid out;
  out.spacing_m = static_cast<double>(step) * world.voxel_m();
  out.edge = std::max(64, static_cast<int>(area.edge_m / out.spacing_m));
  const auto corner = [&](double centre) {
    return static_cast<std::int64_t>(std::floor((centre - area.edge_m / 2) / out.spacing_m)) * step;
  };
  const glm::i64vec2 corner_voxel{corner(area.centre_m.x), corner(area.centre_m.y)};
  out.corner_m = glm::dvec2(corner_voxel) * world.voxel_m();
  out.height_m.resize(out.index(0, out.edge));
  out.ridge.resize(out.height_m.size());
  std::vector<ColumnBlock> blocks(static_cast<std::size_t>(strip_workers()));
  for_each_strip("survey", (out.edge + kTileColumns - 1) / kTileColumns, [&](int strip, int worker) {
    ColumnBlock& block = blocks[static_cast<std::size_t>(worker)];
    const int k0 = strip * kTileColumns;
    for (int i0 = 0; i0 < out.edge; i0 += kTileColumns) {
      const int width = std::min(kTileColumns, out.edge - i0);
      const int depth = std::min(kTileColumns, out.edge - k0);
      world.columns({corner_voxel.x + i0 * step, corner_voxel.y + k0 * step, step, width, depth, world.voxel_m()},
                    block);
      for (int k = 0; k < depth; ++k) {
        const auto from = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * block.stride);
        const auto to = static_cast<std::ptrdiff_t>(out.index(i0, k0 + k));
        std::copy_n(block.height_m.begin() + from, width, out.height_m.begin() + to);
        std::copy_n(block.ridge.begin() + from, width, out.ridge.begin() + to);
      }
    }
  });
  return out;
}

SurveyFigures survey_figures(const WorldFunction& world, const SurveyGrid& grid, int probes) {
  SurveyFigures out;
  heights(grid, out);
  slopes_and_streams(grid, out);
  coast(grid, out);
  overhangs(world, grid, probes, out);
  return out;
}

Overhang overhang_at(const WorldFunction& world, glm::dvec2 place_m, DensityBrick& brick) {
  const glm::dvec2 voxel = glm::floor(place_m / world.voxel_m());
  brick.stand(world, static_cast<std::int64_t>(voxel.x), static_cast<std::int64_t>(voxel.y), 1, 1);
  const auto bottom = static_cast<std::int64_t>(std::floor(brick.rock_below_m() / world.voxel_m())) - 2;
  const auto top = static_cast<std::int64_t>(std::ceil(brick.air_above_m() / world.voxel_m())) + 2;
  const int layers = static_cast<int>(top - bottom) + 1;
  brick.sample(world, bottom, layers);
  double air_from = -1;
  for (int j = 0; j < layers; ++j) {
    const bool is_rock = brick.corners(0, std::min(j, layers - 2), 0)[j < layers - 1 ? 0 : 2] < 0;
    if (is_rock && air_from >= 0) {
      return {true, static_cast<double>(bottom + j) * world.voxel_m(), (j - air_from) * world.voxel_m()};
    }
    if (!is_rock && air_from < 0) air_from = j;
  }
  return {};
}

}  // namespace talus::cli
