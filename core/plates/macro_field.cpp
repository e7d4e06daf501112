#include "core/plates/macro_field.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/hash.hpp"
#include "core/plates/macro_ground.hpp"
#include "core/plates/macro_lattice.hpp"
#include "core/plates/macro_nodes.hpp"

namespace talus {

/// The arrays over a grid of nodes, cut from the scratch.
struct MacroField::Nodes {
  std::array<NodeArrays, kMacroChannels> channel{};
  std::array<NodeArrays, kMacroNoises> noise{};
};

namespace {

constexpr std::size_t kArrays = 3 * (std::size_t{kMacroChannels} + std::size_t{kMacroNoises});

NodeArrays row_of(const NodeArrays& a, std::size_t at) {
  return {a.v + at, a.x + at, a.z + at};
}

/// Nodes i..i + 3, k..k + 3 of a grid, those past its end repeating the last one; and the box they fill, in metres.
struct PlacedGroup {
  NodeGroup nodes;
  glm::i64vec2 origin_m;
  glm::i64vec2 size_m;
};

PlacedGroup group_at(const ColumnGrid& grid, int i, int k) {
  const auto metres = [&](std::int64_t voxel) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(voxel) * grid.voxel_m));
  };
  const auto voxel = [&](std::int64_t first, int n, int count) {
    return first + std::min(n, count - 1) * grid.step_voxel;
  };
  PlacedGroup out;
  out.origin_m = {metres(voxel(grid.x_voxel, i, grid.width)), metres(voxel(grid.z_voxel, k, grid.depth))};
  const auto along_x = [&](int n) { return metres(voxel(grid.x_voxel, i + n, grid.width)) - out.origin_m.x; };
  const auto along_z = [&](int n) { return metres(voxel(grid.z_voxel, k + n, grid.depth)) - out.origin_m.y; };
  for (int n = 0; n < static_cast<int>(kGroupNodes); ++n) {
    out.nodes.x[static_cast<std::size_t>(n)] = static_cast<float>(along_x(n % kGroupEdge));
    out.nodes.z[static_cast<std::size_t>(n)] = static_cast<float>(along_z(n / kGroupEdge));
  }
  out.size_m = {along_x(kGroupEdge - 1), along_z(kGroupEdge - 1)};
  return out;
}

void scatter(const GroupJet& from, int rows, std::size_t stride, const NodeArrays& to) {
  for (int row = 0; row < rows; ++row) {
    const auto at = static_cast<std::size_t>(row) * kGroupEdge;
    const std::size_t there = static_cast<std::size_t>(row) * stride;
    std::copy_n(&from.v[at], kGroupEdge, to.v + there);
    std::copy_n(&from.x[at], kGroupEdge, to.x + there);
    std::copy_n(&from.z[at], kGroupEdge, to.z + there);
  }
}

}  // namespace

MacroField::MacroField(const PlateControls& plates, const MacroControls& macro)
    : plates_(plates, macro),
      uplift_{5200, 2, 2.1, 0.4, mix64(macro.seed, 1)},
      arc_{3600, 2, 2.1, 0.4, mix64(macro.seed, 2)},
      pass_{macro.pass_m, 2, 2.1, 0.35, mix64(macro.seed, 3)},
      swell_{9000, 3, 2.0, 0.5, mix64(macro.seed, 4)},
      coast_{macro.coast_wavelength_m, 5, 2.0, 0.5, mix64(macro.seed, 5)} {}

void MacroField::sum_plates(const ColumnGrid& nodes, MacroScratch& scratch, const Nodes& out) const {
  const MacroControls& m = plates_.macro();
  const ShelfTerms coast{static_cast<float>(1.0 / m.shelf_m), static_cast<float>(m.continental_slope_m),
                         static_cast<float>(m.shelf_depth_m)};
  const std::size_t stride = row_stride(nodes);
  for (int k = 0; k < nodes.depth; k += kGroupEdge) {
    for (int i = 0; i < nodes.width; i += kGroupEdge) {
      const PlacedGroup group = group_at(nodes, i, k);
      GroupSums sums;
      for (const Site& site : scratch.gather.near(plates_, group.origin_m, group.origin_m + group.size_m)) {
        const PlacedPlate placed{&scratch.plates.load(plates_, site.key), site.at_m - group.origin_m};
        if (can_share(placed, {0, 0}, glm::dvec2(group.size_m))) add_plate(placed, coast, group.nodes, sums);
      }
      finish_group(sums);
      const int rows = std::min(kGroupEdge, nodes.depth - k);
      const std::size_t at = static_cast<std::size_t>(k) * stride + static_cast<std::size_t>(i);
      for (std::size_t c = 0; c < kMacroChannels; ++c)
        scatter(sums.channel[c], rows, stride, row_of(out.channel[c], at));
    }
  }
}

void MacroField::fill_nodes(const ColumnGrid& nodes, MacroScratch& scratch, const Nodes& out) const {
  sum_plates(nodes, scratch, out);
  const std::size_t stride = row_stride(nodes);
  const std::size_t count = sample_count(nodes);
  const std::array<const FractalNoise*, kMacroNoises> noises{&uplift_, &arc_, &pass_, &swell_, &coast_};
  for (std::size_t n = 0; n < kMacroNoises; ++n) {
    fractal_noise(*noises[n], nodes, {out.noise[n].v, count}, {out.noise[n].x, count}, {out.noise[n].z, count});
  }
  for (std::size_t at = 0; at < count; at += stride) {
    GroundRow row;
    for (std::size_t c = 0; c < kMacroChannels; ++c) row.channel[c] = row_of(out.channel[c], at);
    for (std::size_t n = 0; n < kMacroNoises; ++n) row.noise[n] = row_of(out.noise[n], at);
    ground_row(plates_.macro(), row, static_cast<std::size_t>(nodes.width));
  }
}

void MacroField::sample(const ColumnGrid& grid, MacroScratch& scratch, const MacroArrays& out) const {
  if (!lies_on_lattice(grid.x_voxel, grid.step_voxel) || !lies_on_lattice(grid.z_voxel, grid.step_voxel))
    return sample_apart(grid, scratch, out);
  const NodeAxis x = node_axis(grid.x_voxel, grid.step_voxel, grid.width);
  const NodeAxis z = node_axis(grid.z_voxel, grid.step_voxel, grid.depth);
  const ColumnGrid nodes{x.first_voxel, z.first_voxel, x.step_voxel, x.nodes, z.nodes, grid.voxel_m, grid.wrap_voxel};
  const std::size_t count = sample_count(nodes);
  scratch.arrays.resize(std::max(scratch.arrays.size(), count * kArrays));
  float* next = scratch.arrays.data();
  const auto take = [&] {
    const NodeArrays taken{next, next + count, next + 2 * count};
    next += 3 * count;
    return taken;
  };
  Nodes made;
  for (NodeArrays& channel : made.channel) channel = take();
  for (NodeArrays& noise : made.noise) noise = take();
  fill_nodes(nodes, scratch, made);

  const std::size_t stride = row_stride(nodes);
  const auto spacing_m = static_cast<float>(static_cast<double>(kMacroNodeVoxels) * grid.voxel_m);
  const auto width = static_cast<std::size_t>(grid.width);
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const auto first = static_cast<std::size_t>(z.left[k]);
    const std::size_t before = first * stride;
    const std::size_t after = std::min(first + 1, static_cast<std::size_t>(nodes.depth) - 1) * stride;
    const std::size_t at = k * row_stride(grid);
    const auto row = [&](MacroChannel c, float* v, float* slope_x, float* slope_z) {
      interpolate_row(x, row_of(made.channel[c], before), row_of(made.channel[c], after), z.fraction[k], spacing_m,
                      width, v, slope_x, slope_z);
    };
    row(kUplift, out.height + at, out.height_x + at, out.height_z + at);
    row(kHilly, out.hilliness + at, out.hilliness_x + at, out.hilliness_z + at);
    row(kBase, out.floor + at, nullptr, nullptr);
    row(kCrest, out.lift + at, nullptr, nullptr);
  }
}

/// Columns wider apart than nodes and not on them share none: each is a grid of its own.
void MacroField::sample_apart(const ColumnGrid& grid, MacroScratch& scratch, const MacroArrays& out) const {
  alignas(64) std::array<float, 8 * kRowPadding> one;
  float* const from = one.data();
  const auto part = [&](std::size_t n) { return from + n * kRowPadding; };
  const MacroArrays single{part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7)};
  for (int k = 0; k < grid.depth; ++k) {
    for (int i = 0; i < grid.width; ++i) {
      const std::size_t at = static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
      sample({grid.x_voxel + i * grid.step_voxel, grid.z_voxel + k * grid.step_voxel, 1, 1, 1, grid.voxel_m,
              grid.wrap_voxel},
             scratch, single);
      out.height[at] = *single.height;
      out.height_x[at] = *single.height_x;
      out.height_z[at] = *single.height_z;
      out.hilliness[at] = *single.hilliness;
      out.hilliness_x[at] = *single.hilliness_x;
      out.hilliness_z[at] = *single.hilliness_z;
      out.floor[at] = *single.floor;
      out.lift[at] = *single.lift;
    }
  }
}

double MacroField::low_m() const {
  const MacroControls& m = plates_.macro();
  const double sea = m.sea_floor_m - m.sea_range_m * (noise_bound({1, 2, 2, 0.5, 0}) + 0.4) - m.trench_m;
  const double rift = m.land_m - 2 * m.land_range_m - 1.25 * m.rift_m * (1 + m.uplift_noise);
  return std::min({sea, rift, -m.shelf_depth_m - m.trench_m}) -
         0.6 * (m.swell_m * noise_bound(swell_) + m.coast_m * noise_bound(coast_));
}

double MacroField::high_m() const {
  const MacroControls& m = plates_.macro();
  const double crest = std::max({m.collision_m, m.subduction_m, m.arc_m, m.ocean_ridge_m, m.rift_m, m.old_fault_m});
  return m.land_m + m.land_range_m + crest * (1 + m.uplift_noise) +
         0.6 * (m.swell_m * noise_bound(swell_) + m.coast_m * noise_bound(coast_));
}

}  // namespace talus
