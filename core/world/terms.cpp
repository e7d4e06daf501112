#include "core/world/terms.hpp"

#include <utility>

#include "core/base/hash.hpp"

namespace talus {
namespace {

/// Reads a manifest section by section.
class Reader {
 public:
  explicit Reader(const Manifest& manifest) : manifest_(manifest) {}
  double number(std::string_view name) const { return parameter(manifest_, name); }
  float real(std::string_view name) const { return static_cast<float>(number(name)); }
  int whole(std::string_view name) const { return static_cast<int>(number(name)); }
  /// A stream of chance of its own for each use.
  std::uint64_t seed(std::uint64_t use) const { return mix64(manifest_.seed, use); }

 private:
  const Manifest& manifest_;
};

ErosionControls erosion_of(const Reader& m) {
  ErosionControls c;
  c.scale_m = m.number("erosion.scale_m");
  c.octaves = m.whole("erosion.octaves");
  c.strength = m.number("erosion.strength");
  c.gain = m.number("erosion.gain");
  c.lacunarity = m.number("erosion.lacunarity");
  c.gully_weight = m.number("erosion.gully_weight");
  c.detail = m.number("erosion.detail");
  c.rounding_ridge = m.number("erosion.rounding_ridge");
  c.rounding_crease = m.number("erosion.rounding_crease");
  c.rounding_input = m.number("erosion.rounding_input");
  c.rounding_octave = m.number("erosion.rounding_octave");
  c.onset_input = m.number("erosion.onset_input");
  c.onset_octave = m.number("erosion.onset_octave");
  c.ridge_onset_input = m.number("erosion.ridge_onset_input");
  c.ridge_onset_octave = m.number("erosion.ridge_onset_octave");
  c.assumed_slope = m.number("erosion.assumed_slope");
  c.assumed_blend = m.number("erosion.assumed_blend");
  c.cell_scale = m.number("erosion.cell_scale");
  c.normalisation = m.number("erosion.normalisation");
  c.offset = m.number("erosion.offset");
  c.frequency_slope = m.number("erosion.frequency_slope");
  c.frequency_max = m.number("erosion.frequency_max");
  c.frequency_branch = m.number("erosion.frequency_branch");
  c.frequency_pull = m.number("erosion.frequency_pull");
  c.frequency_valley = m.number("erosion.frequency_valley");
  c.seed = m.seed(7);
  return c;
}

CoastControls coast_of(const Reader& m) {
  CoastControls c;
  c.cliff_m = m.number("coast.cliff_m");
  c.cliff_vary_m = m.number("coast.cliff_vary_m");
  c.cliff_share = m.number("coast.cliff_share");
  c.cliff_slope = m.number("coast.cliff_slope");
  c.district_m = m.number("coast.district_m");
  c.fin_m = m.number("coast.fin_m");
  c.fin_wavelength_m = m.number("coast.fin_wavelength_m");
  c.joint_m = m.number("coast.joint_m");
  c.shelf = m.number("coast.shelf");
  c.beach = m.number("coast.beach");
  c.seed = m.seed(14);
  return c;
}

ConeControls cones_of(const Reader& m) {
  ConeControls c;
  c.cell_m = m.number("cones.cell_m");
  c.land_share = m.number("cones.land_share");
  c.sea_share = m.number("cones.sea_share");
  c.volcano_m = m.number("cones.volcano_m");
  c.seamount_m = m.number("cones.seamount_m");
  c.cinder_m = m.number("cones.cinder_m");
  c.seed = m.seed(15);
  return c;
}

DetailControls detail_of(const Reader& m) {
  DetailControls c;
  const int octaves = m.whole("micro.octaves");
  c.rough = {m.number("micro.wavelength_m"), octaves > 0 ? octaves : 1, 2.0, 0.5, m.seed(8)};
  c.rough_plain_m = octaves > 0 ? m.number("micro.base_m") : 0;
  c.rough_hill_m = octaves > 0 ? m.number("micro.hill_m") : 0;
  c.joint_m = m.number("detail.joint_m");
  c.boulder_m = m.number("detail.boulder_m");
  c.boulder_share = m.number("detail.boulder_share");
  c.rock_slope = m.number("cover.rock_slope");
  c.seed = m.seed(16);
  return c;
}

PlateControls plates_of(const Reader& m) {
  PlateControls p;
  p.size_m = m.number("plates.size_m");
  p.jitter = m.number("plates.jitter");
  p.big_share = m.number("plates.big_share");
  p.cluster_m = m.number("plates.continent_m");
  p.scatter = m.number("plates.scatter");
  p.ocean = m.number("plates.ocean");
  p.group_speed = m.number("plates.group_speed");
  p.own_speed = m.number("plates.own_speed");
  p.wiggle = m.number("plates.wiggle");
  p.wiggle_m = m.number("plates.wiggle_m");
  p.blend_m = m.number("plates.blend_m");
  p.wrap_m = static_cast<std::int64_t>(m.number("world.wrap_m"));
  p.seed = m.seed(1);
  return p;
}

MacroControls macro_of(const Reader& m) {
  MacroControls c;
  c.land_m = m.number("macro.land_m");
  c.land_range_m = m.number("macro.land_range_m");
  c.sea_floor_m = m.number("macro.sea_floor_m");
  c.sea_range_m = m.number("macro.sea_range_m");
  c.collision_m = m.number("macro.collision_m");
  c.subduction_m = m.number("macro.subduction_m");
  c.arc_m = m.number("macro.arc_m");
  c.ocean_ridge_m = m.number("macro.ocean_ridge_m");
  c.rift_m = m.number("macro.rift_m");
  c.old_fault_m = m.number("macro.old_fault_m");
  c.trench_m = m.number("macro.trench_m");
  c.range_width = m.number("macro.range_width");
  c.shelf_m = m.number("macro.shelf_m");
  c.shelf_depth_m = m.number("macro.shelf_depth_m");
  c.continental_slope_m = m.number("macro.continental_slope_m");
  c.uplift_noise = m.number("macro.uplift_noise");
  c.pass_depth = m.number("macro.pass_depth");
  c.pass_m = m.number("macro.pass_wavelength_m");
  c.swell_m = m.number("macro.swell_m");
  c.coast_m = m.number("macro.coast_m");
  c.coast_wavelength_m = m.number("macro.coast_wavelength_m");
  c.seed = m.seed(2);
  return c;
}

/// Every district's share and shape.
void read_districts(const Reader& m, WorldFunction::Terms& t) {
  t.districts = {m.number("districts.wavelength_m"),
                 m.number("districts.border"),
                 {m.number("districts.badlands"), m.number("districts.dunes"), m.number("districts.mesas"),
                  m.number("districts.karst"), m.number("districts.glacial")},
                 m.seed(40)};
  t.badlands = {m.number("districts.badland_hill_m"), m.number("districts.badland_wavelength_m"), m.seed(41)};
  t.mesas = {m.number("districts.mesa_m"), m.number("districts.mesa_wavelength_m"), m.number("districts.canyon_width"),
             m.seed(42)};
  t.dunes = {m.number("districts.dune_m"), m.number("districts.dune_wavelength_m"), m.number("districts.dune_skew"),
             m.number("districts.wind_m"), m.seed(43)};
  t.karst = {m.number("districts.karst_m"), m.number("districts.karst_cell_m"), m.number("districts.karst_towers"),
             m.number("districts.sink_m"), m.seed(44)};
  t.rills = t.erosion;
  t.rills.scale_m = m.number("districts.rill_m");
  t.rills.strength = m.number("districts.rill_strength");
  t.rills.octaves = m.whole("districts.rill_octaves");
  // Soft ground is cut on gentle slopes as well; what is cut is lifted, so that basins do not drown.
  t.rills.onset_input = 2.5 * t.erosion.onset_input;
  t.rills.offset = 0.5;
  t.rills.detail = 1.4 * t.erosion.detail;
  t.rills.seed = m.seed(45);
  t.terraces = std::make_unique<const Terraces>(t.strata->all_sets());
}

ReliefTerms relief_of(const Reader& m) {
  return {m.real("relief.base_m"),       m.real("relief.hill_m"),          m.real("erosion.fade_altitude"),
          m.real("erosion.fade_relief"), m.real("erosion.plain_strength"), m.real("erosion.hill_strength")};
}

}  // namespace

WorldFunction::Terms terms_of(Manifest manifest) {
  const Reader m(manifest);
  WorldFunction::Terms t;
  t.cells = m.whole("chunk.cells");
  t.voxel_m = m.number("chunk.voxel_m");
  t.wrap_voxel = static_cast<std::int64_t>(m.number("world.wrap_m") / t.voxel_m);
  t.macro = std::make_unique<const MacroField>(plates_of(m), macro_of(m));
  t.relief = relief_of(m);
  t.hills = {m.number("relief.wavelength_m"), m.whole("relief.octaves"), m.number("relief.lacunarity"),
             m.number("relief.gain"), m.seed(6)};
  t.erosion = erosion_of(m);
  t.frequency_share = m.real("erosion.frequency_share");
  t.strata = std::make_unique<const Strata>(StrataControls{m.whole("strata.sets"), m.real("strata.ledge"),
                                                           m.real("strata.ledge_slope"), m.number("strata.facies_m"),
                                                           m.number("world.wrap_m"), m.seed(9)});
  read_districts(m, t);
  t.profile = std::make_unique<const HardnessProfile>(*t.strata);
  t.warp = warp_of(manifest);
  t.carve = carve_of(manifest);
  for (const std::byte b : canonical_bytes(manifest)) t.identity = mix64(t.identity, static_cast<std::uint64_t>(b));
  t.fold = {m.number("strata.fold_m"), 4, 2.2, 0.5, m.seed(10)};
  t.fold_m = m.real("strata.deformation_m");
  t.tilt = {m.number("strata.tilt_wavelength_m"), 1, 2.0, 0.5, m.seed(11)};
  t.tilt_m = m.real("strata.tilt_m");
  t.set_choice = {m.number("strata.set_m"), 2, 2.3, 0.35, m.seed(12)};
  t.district = {m.number("strata.district_m"), 3, 3.0, 0.5, m.seed(13)};
  t.resistance = m.real("strata.resistance");
  t.coast = coast_of(m);
  t.cones = cones_of(m);
  t.detail = detail_of(m);
  t.snow_line_m = m.real("cover.snow_line_m");
  t.grass_line_m = m.real("cover.grass_line_m");
  t.beach_m = m.real("cover.beach_m");
  t.rock_slope = m.real("cover.rock_slope");

  // What plates, hills and gullies reach together in practice, rounded outwards; columns are clamped to it, so it is
  // never wrong.
  const double hills = m.number("relief.base_m") + m.number("relief.hill_m");
  const double gullies = erosion_bound(t.erosion);
  const glm::dvec2 eroded_m{t.macro->low_m() - 0.5 * hills - 0.1 * gullies,
                            t.macro->high_m() + hills + gullies + cones_bound(t.cones)};
  const glm::dvec2 shaped_m = karst_bound(t.karst, mesas_bound(t.mesas, badlands_bound(t.badlands, eroded_m)));
  const double moved_m = static_cast<double>(t.terraces->reach_m()) + erosion_bound(t.rills);
  const glm::dvec2 dunes_m = dunes_bound(t.dunes, {shaped_m.x - moved_m, shaped_m.y + moved_m});
  const glm::dvec2 coast_m = coast_bound(t.coast, dunes_m);
  const double detail = detail_bound(t.detail);
  t.low_m = static_cast<float>(coast_m.x - detail);
  t.high_m = static_cast<float>(coast_m.y + detail);
  t.manifest = std::move(manifest);
  return t;
}

}  // namespace talus
