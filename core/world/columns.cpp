// The stages that make columns, in order: plates and hills, cones, districts, rock layers, erosion, rills, ledges,
// dunes, cinders, coast, roughness.
#include <algorithm>
#include <array>
#include <utility>

#include "core/world/arrays.hpp"
#include "core/world/district_stages.hpp"
#include "core/world/relief.hpp"
#include "core/world/terms.hpp"
#include "core/world/world_function.hpp"

namespace talus {
namespace {

NoiseArrays sample(const FractalNoise& noise, const ColumnGrid& grid, Arrays& arrays) {
  const NoiseArrays out{arrays.take(), arrays.take(), arrays.take()};
  fractal_noise(noise, grid, arrays.span(out.v), arrays.span(out.x), arrays.span(out.z));
  return out;
}

NoiseArrays row_of(const NoiseArrays& a, std::size_t at) {
  return {a.v + at, a.x + at, a.z + at};
}

/// Height before erosion and what goes with it.
struct ReliefArrays {
  float *height, *slope_x, *slope_z, *fade, *strength, *hilliness;
};

/// What plates and hills make of the ground, over the arrays behind `arrays`' next one.
void relief_stage(const WorldFunction::Terms& t, const ColumnGrid& grid, Arrays arrays, MacroScratch& scratch,
                  const ReliefArrays& out) {
  const MacroArrays macro{out.height,    out.slope_x,   out.slope_z,   out.hilliness,
                          arrays.take(), arrays.take(), arrays.take(), arrays.take()};
  t.macro->sample(grid, scratch, macro);
  const NoiseArrays hills = sample(t.hills, grid, arrays);
  for (std::size_t at = 0; at < sample_count(grid); at += row_stride(grid)) {
    relief_row(
        t.relief,
        {macro.hilliness + at, macro.hilliness_x + at, macro.hilliness_z + at, macro.floor + at, macro.lift + at,
         row_of(hills, at), out.height + at, out.slope_x + at, out.slope_z + at, out.fade + at, out.strength + at},
        static_cast<std::size_t>(grid.width));
  }
}

/// Volcanoes and seamounts on top of it; cinder cones are found too. Whether a cone stands depends on the relief at its
/// centre.
void cone_stage(const WorldFunction::Terms& t, const ColumnGrid& grid, Arrays arrays, ColumnWorkspace& workspace,
                const ReliefArrays& relief) {
  find_cone_sites(t.cones, grid, workspace.cone_sites);
  workspace.cones.clear();
  for (const ConeSite& site : workspace.cone_sites) {
    const auto voxel = [&](double at_m) { return static_cast<std::int64_t>(at_m / grid.voxel_m); };
    const ColumnGrid centre{voxel(site.x_m), voxel(site.z_m), 1, 1, 1, grid.voxel_m, grid.wrap_voxel};
    alignas(64) std::array<float, 6 * kRowPadding> ground{};
    float* const at = ground.data();
    relief_stage(
        t, centre, Arrays(arrays, sample_count(centre)), workspace.macro,
        {at, at + kRowPadding, at + 2 * kRowPadding, at + 3 * kRowPadding, at + 4 * kRowPadding, at + 5 * kRowPadding});
    grow_cones(t.cones, site, ground[0], ground[5 * kRowPadding], workspace.cones);
  }
  const auto span = [&](float* array) { return arrays.span(array); };
  raise_cones(t.cones, workspace.cones, grid, {span(relief.height), span(relief.slope_x), span(relief.slope_z)},
              {span(relief.fade), span(relief.strength), span(relief.hilliness)},
              arrays.span(arrays.take(kConeArrays), kConeArrays));
}

/// Arrays that live from stage to stage, and the most that one stage needs: the coast's.
constexpr std::size_t kKeptArrays = 2 + 2 + 1 + 1 + 3 + kDistrictStageArrays;
constexpr std::size_t kWorkspaceArrays = kKeptArrays + kCoastArrays;

/// One call of WorldFunction::columns. Each stage reads what those before it left, and takes its own arrays from the
/// same place.
class ColumnStages {
 public:
  ColumnStages(const WorldFunction::Terms& terms, const ColumnGrid& grid, ColumnBlock& out)
      : t_(terms),
        grid_(grid),
        out_(out),
        stride_(row_stride(grid)),
        count_(sample_count(grid)),
        width_(static_cast<std::size_t>(grid.width)),
        free_(out.workspace.arrays, count_, kWorkspaceArrays),
        districts_(free_, grid, out) {
    out.grid = grid;
    out.has_volume = false;
    out.stride = stride_;
    for (auto* array : {&out.height_m, &out.slope_x, &out.slope_z, &out.steepness, &out.ridge, &out.hilliness,
                        &out.stack_m, &out.choice, &out.cliff_m, &out.beach})
      array->resize(count_);
    relief_x_ = free_.take();
    relief_z_ = free_.take();
    fade_ = free_.take();
    strength_ = free_.take();
    hardness_ = free_.take();
    fashion_ = free_.take();
    district_ = sample(t_.district, grid, free_).v;
  }

  void relief() {
    const ReliefArrays relief{out_.height_m.data(), relief_x_, relief_z_, fade_, strength_, out_.hilliness.data()};
    relief_stage(t_, grid_, free_, out_.workspace.macro, relief);
    cone_stage(t_, grid_, free_, out_.workspace, relief);
    raise_landforms(t_, ground(), out_.hilliness, free_.span(fade_), grid_, free_, districts_);
  }

  /// Where the rock layers lie, and how they withstand erosion.
  void strata() {
    Arrays arrays = free_;
    const NoiseArrays fold = sample(t_.fold, grid_, arrays);
    const NoiseArrays tilt = sample(t_.tilt, grid_, arrays);
    const NoiseArrays set_choice = sample(t_.set_choice, grid_, arrays);
    for (std::size_t at = 0; at < count_; at += stride_) {
      strata_place_row(t_,
                       {fold.v + at, fold.x + at, tilt.v + at, set_choice.v + at, &out_.hilliness[at],
                        &out_.stack_m[at], &out_.choice[at], fashion_ + at},
                       width_);
    }
    lay_tables(t_, districts_, ground(), out_);
    for (std::size_t at = 0; at < count_; at += stride_) {
      t_.strata->hardness_row(strata_row(at), &out_.height_m[at], hardness_ + at);
      resist_row(t_.resistance, hardness_ + at, strength_ + at, width_);
    }
  }

  /// Gullies, ridges and the ridge map; the ledges of hard layers; cinder cones, which are younger than both.
  void erosion() {
    Arrays arrays = free_;
    float* change = arrays.take();
    float* change_x = arrays.take();
    float* change_z = arrays.take();
    std::span<float> shares;
    if (t_.frequency_share > 0 || districts_.weights.has(District::kGlacial)) shares = arrays.span(arrays.take());
    share_erosion(t_.frequency_share, districts_, arrays.span(strength_), shares);
    const GroundArrays changes{arrays.span(change), arrays.span(change_x), arrays.span(change_z)};
    const GroundArrays cut{arrays.span(arrays.take()), arrays.span(arrays.take()), arrays.span(arrays.take())};
    erode(t_.erosion, grid_,
          {arrays.span(relief_x_), arrays.span(relief_z_), arrays.span(fade_), arrays.span(strength_), shares},
          {changes.height_m, changes.slope_x, changes.slope_z, out_.ridge, cut.height_m, cut.slope_x, cut.slope_z});
    add_rills(t_, districts_, ground(), {changes, cut}, arrays, out_);
    show_ledges(districts_, arrays.span(district_));
    for (std::size_t at = 0; at < count_; at += stride_) {
      float* height = &out_.height_m[at];
      float* slope_x = &out_.slope_x[at];
      float* slope_z = &out_.slope_z[at];
      std::copy_n(relief_x_ + at, stride_, slope_x);
      std::copy_n(relief_z_ + at, stride_, slope_z);
      add_change_row({change + at, change_x + at, change_z + at, height, slope_x, slope_z}, width_);
      t_.strata->bed_hardness_row(strata_row(at), height, hardness_ + at);
      withstand_row(t_.resistance,
                    {hardness_ + at, &cut.height_m[at], &cut.slope_x[at], &cut.slope_z[at], height, slope_x, slope_z},
                    width_);
      t_.strata->ledge_row(strata_row(at), relief_x_ + at, relief_z_ + at, height, slope_x, slope_z);
    }
    if (districts_.weights.has(District::kDunes)) {
      dunes(t_.dunes, grid_, districts_.weights[District::kDunes], {out_.height_m, out_.slope_x, out_.slope_z},
            free_.borrow(kDuneArrays));
    }
    Arrays again = free_;
    heap_cinders(t_.cones, out_.workspace.cones, grid_, {out_.height_m, out_.slope_x, out_.slope_z},
                 again.span(again.take(kConeArrays), kConeArrays));
  }

  /// Cliffs and beaches.
  void shore() {
    Arrays arrays = free_;
    coast(t_.coast, grid_, {districts_.shore_x, districts_.shore_z, out_.hilliness},
          {out_.height_m, out_.slope_x, out_.slope_z, out_.cliff_m, out_.beach},
          arrays.span(arrays.take(kCoastArrays), kCoastArrays));
  }

  /// What lies below the gullies' scale, the clamp to the world's heights, and the interval of this block's.
  void surface() {
    Arrays arrays = free_;
    add_detail(t_.detail, grid_, {out_.hilliness, out_.ridge, out_.cliff_m, out_.beach},
               {out_.height_m, out_.slope_x, out_.slope_z}, arrays.span(arrays.take(kDetailArrays), kDetailArrays));
    for (std::size_t at = 0; at < count_; at += stride_) {
      surface_row({t_.low_m, t_.high_m},
                  {&out_.slope_x[at], &out_.slope_z[at], &out_.height_m[at], &out_.steepness[at]}, width_);
    }
    out_.height_low_m = out_.height_high_m = out_.height_m[0];
    for (std::size_t at = 0; at < count_; at += stride_) {
      const auto [low, high] = std::ranges::minmax(std::span(out_.height_m).subspan(at, width_));
      out_.height_low_m = std::min(out_.height_low_m, low);
      out_.height_high_m = std::max(out_.height_high_m, high);
    }
  }

 private:
  GroundArrays ground() { return {out_.height_m, free_.span(relief_x_), free_.span(relief_z_)}; }
  StrataRow strata_row(std::size_t at) const {
    return {&out_.stack_m[at], &out_.choice[at], district_ + at, fashion_ + at, width_};
  }

  const WorldFunction::Terms& t_;
  const ColumnGrid& grid_;
  ColumnBlock& out_;
  std::size_t stride_, count_, width_;
  Arrays free_;  ///< what no stage keeps
  DistrictStages districts_;
  float *relief_x_ = nullptr, *relief_z_ = nullptr, *fade_ = nullptr, *strength_ = nullptr, *hardness_ = nullptr;
  float *district_ = nullptr, *fashion_ = nullptr;  ///< of the ledges: how much they show, and which
};

}  // namespace

void WorldFunction::columns(const ColumnGrid& asked, ColumnBlock& out) const {
  ColumnGrid grid = asked;
  grid.wrap_voxel = terms_->wrap_voxel;
  ColumnStages stages(*terms_, grid, out);
  stages.relief();
  stages.strata();
  stages.erosion();
  stages.shore();
  stages.surface();
}

}  // namespace talus
