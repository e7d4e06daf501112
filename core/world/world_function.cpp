#include "core/world/world_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/world/relief.hpp"
#include "core/world/terms.hpp"

namespace talus {
namespace {

/// Cuts one vector of floats into the arrays of a grid. Sized once, so arrays stay where they are.
class Arrays {
 public:
  Arrays(std::vector<float>& memory, std::size_t count, std::size_t arrays) : count_(count) {
    memory.resize(std::max(memory.size(), count * arrays));
    next_ = memory.data();
  }
  /// The same memory from its next array on, for a smaller grid.
  Arrays(const Arrays& other, std::size_t count) : count_(count), next_(other.next_) {}
  float* take(std::size_t arrays = 1) { return std::exchange(next_, next_ + arrays * count_); }
  std::span<float> span(float* array, std::size_t arrays = 1) const { return {array, arrays * count_}; }
  /// Arrays taken after this can be taken again from `rewind` on.
  float* mark() const { return next_; }
  void rewind(float* mark) { next_ = mark; }

 private:
  std::size_t count_;
  float* next_;
};

NoiseArrays sample(const FractalNoise& noise, const ColumnGrid& grid, Arrays& arrays) {
  const NoiseArrays out{arrays.take(), arrays.take(), arrays.take()};
  fractal_noise(noise, grid, arrays.span(out.v), arrays.span(out.x), arrays.span(out.z));
  return out;
}

/// Height before erosion and what goes with it.
struct ReliefArrays {
  float *height, *slope_x, *slope_z, *fade, *strength, *hilliness;
};

NoiseArrays row_of(const NoiseArrays& a, std::size_t at) {
  return {a.v + at, a.x + at, a.z + at};
}

void resize_outputs(ColumnBlock& out, std::size_t count) {
  for (auto* array : {&out.height_m, &out.slope_x, &out.slope_z, &out.steepness, &out.ridge, &out.hilliness,
                      &out.stack_m, &out.choice, &out.cliff_m, &out.beach})
    array->resize(count);
}

/// Plains, hills and ranges, over the arrays behind `arrays`' next one.
void relief_stage(const WorldFunction::Terms& t, const ColumnGrid& grid, Arrays arrays, const ReliefArrays& out) {
  const NoiseArrays continent = sample(t.continent, grid, arrays);
  const NoiseArrays range = sample(t.range, grid, arrays);
  const NoiseArrays massif = sample(t.massif, grid, arrays);
  const NoiseArrays crest = sample(t.crest, grid, arrays);
  const NoiseArrays swell = sample(t.swell, grid, arrays);
  const NoiseArrays relief = sample(t.relief, grid, arrays);
  for (std::size_t at = 0; at < sample_count(grid); at += row_stride(grid)) {
    relief_row(t.macro,
               {row_of(continent, at), row_of(range, at), row_of(massif, at), row_of(crest, at), row_of(swell, at),
                row_of(relief, at), out.height + at, out.slope_x + at, out.slope_z + at, out.fade + at,
                out.strength + at, out.hilliness + at},
               static_cast<std::size_t>(grid.width));
  }
}

/// Volcanoes and seamounts on top of it; cinder cones are found too. Whether a cone stands depends on the relief at its
/// centre.
void cone_stage(const WorldFunction::Terms& t, const ColumnGrid& grid, Arrays arrays, ColumnBlock& block,
                const ReliefArrays& relief) {
  find_cone_sites(t.cones, grid, block.cone_sites);
  block.cones.clear();
  for (const ConeSite& site : block.cone_sites) {
    const auto voxel = [&](double at_m) { return static_cast<std::int64_t>(at_m / grid.voxel_m); };
    const ColumnGrid centre{voxel(site.x_m), voxel(site.z_m), 1, 1, 1, grid.voxel_m};
    alignas(64) std::array<float, 6 * kRowPadding> ground{};
    float* const at = ground.data();
    relief_stage(
        t, centre, Arrays(arrays, sample_count(centre)),
        {at, at + kRowPadding, at + 2 * kRowPadding, at + 3 * kRowPadding, at + 4 * kRowPadding, at + 5 * kRowPadding});
    grow_cones(t.cones, site, ground[0], ground[5 * kRowPadding], block.cones);
  }
  const auto span = [&](float* array) { return arrays.span(array); };
  raise_cones(t.cones, block.cones, grid, {span(relief.height), span(relief.slope_x), span(relief.slope_z)},
              {span(relief.fade), span(relief.strength), span(relief.hilliness)},
              arrays.span(arrays.take(kConeArrays), kConeArrays));
}

/// Relief's 4, hardness, erosion's 3 and the district's 3 live on; the coast's are the most that one stage needs.
constexpr std::size_t kWorkspaceArrays = 4 + 1 + 3 + 3 + kCoastArrays;

/// Lowest and highest surface of a filled block.
void measure(ColumnBlock& block) {
  block.height_low_m = block.height_high_m = block.height_m[0];
  for (std::size_t at = 0; at < block.height_m.size(); at += block.stride) {
    const auto row = std::span(block.height_m).subspan(at, static_cast<std::size_t>(block.grid.width));
    const auto [low, high] = std::ranges::minmax(row);
    block.height_low_m = std::min(block.height_low_m, low);
    block.height_high_m = std::max(block.height_high_m, high);
  }
}

}  // namespace

WorldFunction::WorldFunction(Manifest manifest) {
  TALUS_CHECK(manifest_faults(manifest).empty());
  terms_ = std::make_unique<const Terms>(terms_of(std::move(manifest)));
}
WorldFunction::~WorldFunction() = default;

const Manifest& WorldFunction::manifest() const {
  return terms_->manifest;
}
int WorldFunction::cells() const {
  return terms_->cells;
}
double WorldFunction::voxel_m() const {
  return terms_->voxel_m;
}
glm::dvec2 WorldFunction::height_range_m() const {
  return {static_cast<double>(terms_->low_m), static_cast<double>(terms_->high_m)};
}

void WorldFunction::columns(const ColumnGrid& grid, ColumnBlock& out) const {
  const Terms& t = *terms_;
  const std::size_t stride = row_stride(grid);
  const std::size_t count = sample_count(grid);
  const auto width = static_cast<std::size_t>(grid.width);
  out.grid = grid;
  out.stride = stride;
  resize_outputs(out, count);
  Arrays arrays(out.workspace, count, kWorkspaceArrays);

  float* relief_x = arrays.take();
  float* relief_z = arrays.take();
  float* fade = arrays.take();
  float* strength = arrays.take();
  float* hardness = arrays.take();
  float* eroded = arrays.take();
  float* eroded_x = arrays.take();
  float* eroded_z = arrays.take();
  const NoiseArrays district = sample(t.district, grid, arrays);
  float* const scratch = arrays.mark();

  const ReliefArrays relief{out.height_m.data(), relief_x, relief_z, fade, strength, out.hilliness.data()};
  relief_stage(t, grid, arrays, relief);
  cone_stage(t, grid, arrays, out, relief);

  arrays.rewind(scratch);
  const NoiseArrays fold = sample(t.fold, grid, arrays);
  const NoiseArrays tilt = sample(t.tilt, grid, arrays);
  const NoiseArrays set_choice = sample(t.set_choice, grid, arrays);
  for (std::size_t at = 0; at < count; at += stride) {
    strata_place_row(t, {fold.v + at, tilt.v + at, set_choice.v + at, &out.stack_m[at], &out.choice[at]}, width);
    t.strata->hardness_row({&out.stack_m[at], &out.choice[at], district.v + at, width}, &out.height_m[at],
                           hardness + at);
    resist_row(t.resistance, hardness + at, strength + at, width);
  }

  erode(t.erosion, grid, {arrays.span(relief_x), arrays.span(relief_z), arrays.span(fade), arrays.span(strength)},
        {arrays.span(eroded), arrays.span(eroded_x), arrays.span(eroded_z), out.ridge});

  for (std::size_t at = 0; at < count; at += stride) {
    float* height = &out.height_m[at];
    float* slope_x = &out.slope_x[at];
    float* slope_z = &out.slope_z[at];
    std::copy_n(relief_x + at, stride, slope_x);
    std::copy_n(relief_z + at, stride, slope_z);
    add_change_row({eroded + at, eroded_x + at, eroded_z + at, height, slope_x, slope_z}, width);
    t.strata->ledge_row({&out.stack_m[at], &out.choice[at], district.v + at, width}, relief_x + at, relief_z + at,
                        height, slope_x, slope_z);
  }

  arrays.rewind(scratch);
  heap_cinders(t.cones, out.cones, grid, {out.height_m, out.slope_x, out.slope_z},
               arrays.span(arrays.take(kConeArrays), kConeArrays));

  arrays.rewind(scratch);
  coast(t.coast, grid, {arrays.span(relief_x), arrays.span(relief_z), out.hilliness},
        {out.height_m, out.slope_x, out.slope_z, out.cliff_m, out.beach},
        arrays.span(arrays.take(kCoastArrays), kCoastArrays));

  arrays.rewind(scratch);
  const NoiseArrays micro = sample(t.micro, grid, arrays);
  for (std::size_t at = 0; at < count; at += stride) {
    surface_row(t,
                {&out.hilliness[at], micro.v + at, micro.x + at, micro.z + at, &out.height_m[at], &out.slope_x[at],
                 &out.slope_z[at], &out.steepness[at]},
                width);
  }
  measure(out);
}

Material WorldFunction::cover(float height_m, float up, float ridge, float hilliness, glm::i64vec2 column_voxel) const {
  const Terms& t = *terms_;
  // A dither per column breaks the lines along which altitude and slope change the cover.
  const std::uint64_t hash = mix64(mix64(t.manifest.seed, static_cast<std::uint64_t>(column_voxel.x)),
                                   static_cast<std::uint64_t>(column_voxel.y));
  const float dither = static_cast<float>(hash >> 40) * 0x1p-24f - 0.5f;
  const float cosine = std::max(up, 0.05f);
  const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
  const float steep = slope + 0.12f * dither;

  if (height_m < t.beach_m + 1.5f * dither && steep < 0.35f) return Material::kSand;
  if (height_m < -1.0f) return steep < t.rock_slope ? Material::kSand : Material::kRock;
  if (steep > t.rock_slope) return Material::kRock;
  if (height_m + 160.0f * dither - 220.0f * (slope - 0.4f) > t.snow_line_m) return Material::kSnow;
  if (ridge < -0.72f && hilliness > 0.15f && slope > 0.12f) return Material::kStreamBed;
  if (height_m + 120.0f * dither > t.grass_line_m) return steep > 0.45f ? Material::kScree : Material::kSoil;
  if (steep > 0.72f * t.rock_slope) return ridge > 0.1f ? Material::kSoil : Material::kScree;
  return Material::kGrass;
}

Material WorldFunction::rock(float stack_m, float choice, float height_m, glm::i64vec2 column_voxel) const {
  const glm::dvec2 place_m = glm::dvec2(column_voxel) * terms_->voxel_m;
  return terms_->strata->rock_at(stack_m, choice, height_m, place_m);
}

LayerPlace WorldFunction::layer(float stack_m, float choice, float height_m, glm::i64vec2 column_voxel) const {
  const glm::dvec2 place_m = glm::dvec2(column_voxel) * terms_->voxel_m;
  return terms_->strata->layer_at(stack_m, choice, height_m, place_m);
}

}  // namespace talus
