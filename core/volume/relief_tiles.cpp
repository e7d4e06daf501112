#include "core/volume/relief_tiles.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/check.hpp"

namespace talus {
namespace {

/// Tables are square windows of the plane, so that tiles nearer to each other than a window never share a slot.
constexpr std::int64_t kFineWindow = 16;
constexpr std::int64_t kWideWindow = 8;
/// Fine tiles along the edge of a wide one, and wide cells along the edge of a fine one.
constexpr std::int64_t kFinePerWide = static_cast<std::int64_t>(kWideNode_m / kFineNode_m);
constexpr int kWideCellsPerFine = kTileCells / static_cast<int>(kFinePerWide);

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

/// A position among the nodes of a tile: the cell, and the fractions in it.
struct CellPlace {
  std::size_t node;
  float fx, fz;
};

CellPlace place_in(const TileName& tile, double tile_m, double node_m, double x_m, double z_m) {
  const auto fx = static_cast<float>((x_m - static_cast<double>(tile.x) * tile_m) / node_m);
  const auto fz = static_cast<float>((z_m - static_cast<double>(tile.z) * tile_m) / node_m);
  const int i = std::clamp(static_cast<int>(fx), 0, kTileCells - 1);
  const int k = std::clamp(static_cast<int>(fz), 0, kTileCells - 1);
  return {static_cast<std::size_t>(k * kTileNodes + i), fx - static_cast<float>(i), fz - static_cast<float>(k)};
}

float between(const ReliefTile::Nodes& nodes, const CellPlace& at) {
  const float near = nodes[at.node] + (nodes[at.node + 1] - nodes[at.node]) * at.fx;
  const float far =
      nodes[at.node + kTileNodes] + (nodes[at.node + kTileNodes + 1] - nodes[at.node + kTileNodes]) * at.fx;
  return near + (far - near) * at.fz;
}

std::int64_t tile_index(double at_m, double tile_m) {
  return static_cast<std::int64_t>(std::floor(at_m / tile_m));
}

}  // namespace

Relief::Relief(HeightSource& source, ReliefMemory& memory)
    : source_(source), memory_(memory), identity_(source.identity()) {
  memory_.fine.resize(static_cast<std::size_t>(kFineWindow * kFineWindow));
  memory_.wide.resize(static_cast<std::size_t>(kWideWindow * kWideWindow));
}

const ReliefTile& Relief::tile(std::vector<ReliefTile>& slots, std::int64_t window, double node_m, std::int64_t x,
                               std::int64_t z) {
  const std::int64_t slot = (x & (window - 1)) + (z & (window - 1)) * window;
  ReliefTile& found = slots[static_cast<std::size_t>(slot)];
  const TileName name{identity_, x, z};
  if (!found.known || found.name != name) {
    last_ = nullptr;
    found.known = false;
    found.name = name;
    if (memory_.others == nullptr || !memory_.others->load(node_m, found)) {
      fill(found, node_m);
      if (memory_.others != nullptr) memory_.others->store(node_m, found);
    }
    found.known = true;
  }
  return found;
}

const ReliefTile& Relief::fine_tile(std::int64_t x, std::int64_t z) {
  return tile(memory_.fine, kFineWindow, kFineNode_m, x, z);
}

const ReliefTile& Relief::wide_tile(std::int64_t x, std::int64_t z) {
  return tile(memory_.wide, kWideWindow, kWideNode_m, x, z);
}

const ReliefTile& Relief::fine_tile_at(double x_m, double z_m) {
  const double east_m = x_m - last_x_m_;
  const double south_m = z_m - last_z_m_;
  if (last_ != nullptr && east_m >= 0 && east_m < kFineTile_m && south_m >= 0 && south_m < kFineTile_m) return *last_;
  const ReliefTile& found = fine_tile(tile_index(x_m, kFineTile_m), tile_index(z_m, kFineTile_m));
  last_ = &found;
  last_x_m_ = static_cast<double>(found.name.x) * kFineTile_m;
  last_z_m_ = static_cast<double>(found.name.z) * kFineTile_m;
  return found;
}

void Relief::fill(ReliefTile& tile, double node_m) {
  const auto step = static_cast<std::int64_t>(node_m / source_.voxel_m());
  const auto corner = [&](std::int64_t t) { return t * kTileCells * step - step; };
  const ColumnGrid grid{corner(tile.name.x), corner(tile.name.z), step,
                        kTileNodes + 2,      kTileNodes + 2,      source_.voxel_m()};
  const std::span<const float> heights = source_.heights(grid);
  const std::size_t stride = row_stride(grid);
  TALUS_CHECK(heights.size() >= sample_count(grid));
  const auto per_m = static_cast<float>(1.0 / node_m);
  for (std::size_t k = 0; k < kTileNodes; ++k) {
    for (std::size_t i = 0; i < kTileNodes; ++i) {
      const float* here = &heights[(k + 1) * stride + i + 1];
      const float west = here[-1];
      const float east = here[1];
      const float north = *(here - stride);
      const float south = here[stride];
      const std::size_t node = k * kTileNodes + i;
      tile.height_m[node] = *here;
      tile.slope_x[node] = (east - west) * (0.5f * per_m);
      tile.slope_z[node] = (south - north) * (0.5f * per_m);
      tile.rise[node] =
          std::max({std::abs(west - *here), std::abs(east - *here), std::abs(north - *here), std::abs(south - *here)}) *
          per_m;
    }
  }
}

ReliefPoint Relief::at(double x_m, double z_m) {
  const ReliefTile& t = fine_tile_at(x_m, z_m);
  const CellPlace place = place_in(t.name, kFineTile_m, kFineNode_m, x_m, z_m);
  return {between(t.height_m, place), between(t.slope_x, place), between(t.slope_z, place)};
}

float Relief::height_at(double x_m, double z_m) {
  const ReliefTile& t = fine_tile_at(x_m, z_m);
  return between(t.height_m, place_in(t.name, kFineTile_m, kFineNode_m, x_m, z_m));
}

ReliefPoint Relief::wide_at(double x_m, double z_m) {
  const ReliefTile& t = wide_tile(tile_index(x_m, kWideTile_m), tile_index(z_m, kWideTile_m));
  const CellPlace place = place_in(t.name, kWideTile_m, kWideNode_m, x_m, z_m);
  return {between(t.height_m, place), between(t.slope_x, place), between(t.slope_z, place)};
}

float Relief::gate_at(double x_m, double z_m) {
  const ReliefTile& t = wide_tile(tile_index(x_m, kWideTile_m), tile_index(z_m, kWideTile_m));
  const CellPlace at = place_in(t.name, kWideTile_m, kWideNode_m, x_m, z_m);
  const auto gate = [&](std::size_t node) {
    const float s = std::clamp((t.rise[node] - kStillRise) / (kOpenRise - kStillRise), 0.0f, 1.0f);
    return s * s * (3.0f - (s + s));
  };
  const float near_left = gate(at.node);
  const float far_left = gate(at.node + kTileNodes);
  const float near = near_left + (gate(at.node + 1) - near_left) * at.fx;
  const float far = far_left + (gate(at.node + kTileNodes + 1) - far_left) * at.fx;
  return near + (far - near) * at.fz;
}

TileOutlook Relief::outlook(std::int64_t x, std::int64_t z) {
  const std::int64_t wide_x = floor_div(x, kFinePerWide);
  const std::int64_t wide_z = floor_div(z, kFinePerWide);
  const ReliefTile& t = wide_tile(wide_x, wide_z);
  const auto first_x = static_cast<std::size_t>((x - wide_x * kFinePerWide) * kWideCellsPerFine);
  const auto first_z = static_cast<std::size_t>((z - wide_z * kFinePerWide) * kWideCellsPerFine);
  const std::size_t corner = first_z * kTileNodes + first_x;
  TileOutlook out{t.height_m[corner], t.height_m[corner], 0.0f};
  for (std::size_t k = 0; k <= kWideCellsPerFine; ++k) {
    for (std::size_t i = 0; i <= kWideCellsPerFine; ++i) {
      const std::size_t node = corner + k * kTileNodes + i;
      out.low_m = std::min(out.low_m, t.height_m[node]);
      out.high_m = std::max(out.high_m, t.height_m[node]);
      out.rise = std::max(out.rise, t.rise[node]);
    }
  }
  return out;
}

}  // namespace talus
