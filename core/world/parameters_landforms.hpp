// Parameters of a world: hills, gullies, rock layers, cones, coasts, districts.
// Name, unit, limits, default, whole numbers only, meaning.
#pragma once

#include <array>

#include "core/world/manifest.hpp"

namespace talus {

// clang-format off
inline constexpr std::array kLandformParameters = std::to_array<ParameterInfo>({
  {"relief.wavelength_m", "m", 200, 20000, 3200, false, "Largest wavelength of hills: more means broader hills."},
  {"relief.octaves", "", 1, 8, 4, true, "Octaves of hills: more adds finer hills, which makes gullies less orderly."},
  {"relief.lacunarity", "", 1.5, 3, 2.03, false, "Frequency from one octave to the next: more spreads the octaves further apart."},
  {"relief.gain", "", 0, 0.8, 0.28, false, "Amplitude from one octave to the next: above 0.4 gullies turn to wool."},
  {"relief.base_m", "m", 0, 200, 22, false, "Amplitude of hills on plains: more makes plains rolling."},
  {"relief.hill_m", "m", 0, 1500, 260, false, "Amplitude of hills where hilliness is 1: more means a rougher massif before erosion."},

  {"erosion.scale_m", "m", 50, 10000, 1000, false, "Wavelength of the largest gullies: more means wider spurs and valleys."},
  {"erosion.octaves", "", 0, 10, 7, true, "Octaves of gullies: more means finer branches; 0 turns erosion off."},
  {"erosion.strength", "", 0, 1, 0.175, false, "Depth of gullies as a share of their scale: more means deeper valleys and steeper flanks."},
  {"erosion.gain", "", 0.1, 0.9, 0.5, false, "Depth from one octave to the next: more means coarser fine branches."},
  {"erosion.lacunarity", "", 1.5, 3, 2, false, "Frequency from one octave to the next: more means a wider jump between branch sizes."},
  {"erosion.gully_weight", "", 0, 1, 0.5, false, "Share of gullies against pointed peaks: more means deeper gullies and rounder peaks."},
  {"erosion.detail", "", 0.1, 5, 1.8, false, "How far fine gullies reach on to gentle slopes: less restricts them to steep ones."},
  {"erosion.rounding_ridge", "", 0, 1, 0.05, false, "Rounding of ridges: more means softer crests."},
  {"erosion.rounding_crease", "", 0, 1, 0.03, false, "Rounding of creases: more means valley floors filled with sediment."},
  {"erosion.rounding_input", "", 0, 10, 0.1, false, "Rounding of the peaks and valleys that were there before: more means softer ones."},
  {"erosion.rounding_octave", "", 0.5, 4, 2, false, "Rounding from one octave to the next: the lacunarity keeps one size at every octave, less makes fine gullies sharper."},
  {"erosion.onset_input", "", 0.01, 10, 1.25, false, "Slope of the input at which gullies set in: more lets them begin on gentler slopes."},
  {"erosion.onset_octave", "", 0.01, 10, 1.25, false, "Steepness of a gully's side at which finer ones set in: more lets them begin nearer its crest."},
  {"erosion.ridge_onset_input", "", 0.01, 10, 2.8, false, "The same for the ridge map's input: more means thinner lines at peaks and valleys."},
  {"erosion.ridge_onset_octave", "", 0.01, 10, 1.5, false, "The same for the ridge map's octaves: more means thinner drainage lines."},
  {"erosion.assumed_slope", "", 0, 5, 0.7, false, "Slope that gully directions assume of the input: more makes branches leave at smaller angles."},
  {"erosion.assumed_blend", "", 0, 1, 1, false, "Share of the assumed slope against the real one: less lets gullies overpower peaks and valleys."},
  {"erosion.cell_scale", "", 0.2, 2, 0.7, false, "Stripes per cell: more means longer, more distorted gullies, less means grain."},
  {"erosion.normalisation", "", 0, 0.99, 0.5, false, "How much stripes are brought to one depth: more means crisper gullies, near 1 spikes appear."},
  {"erosion.offset", "", -1, 1, 0, false, "Lifts what erosion touched by this share of its magnitude: below 0 lowers it."},
  {"erosion.frequency_share", "", 0, 1, 0, false, "Share of the frequency method everywhere: more means smoother valleys and rounder spurs, 0 leaves all to the fade method and its crisp gullies."},
  {"erosion.frequency_slope", "", 0.1, 10, 2.4, false, "Frequency method: gullies per scale on a slope of 1; more means closer gullies on gentler ground, less leaves broad smooth flanks."},
  {"erosion.frequency_max", "", 0.2, 5, 1.6, false, "Frequency method: gullies per scale that no slope passes; more lets walls splinter, less keeps them broad."},
  {"erosion.frequency_branch", "", 0, 5, 1, false, "Frequency method: how far the sides of gullies turn finer ones; more branches at wider angles, 0 combs all downhill."},
  {"erosion.frequency_pull", "", 0, 1, 0.8, false, "Frequency method: how far peaks and valley floors are parted; more means deeper troughs, 0 leaves them as the relief has them."},
  {"erosion.frequency_valley", "", 0, 1, 1, false, "Frequency method: how far gullies give out towards valley floors; more means smooth floors, 0 lets gullies cross them."},
  {"erosion.fade_altitude", "", 0, 2, 0.55, false, "How much altitude decides what is peak and what is valley: more sharpens peaks and valley floors."},
  {"erosion.fade_relief", "", 0, 2, 0.75, false, "How much the hills decide what is peak and what is valley: more gives each hill its own peak."},
  {"erosion.plain_strength", "", 0, 1, 0.06, false, "Erosion where hilliness is 0: more engraves plains."},
  {"erosion.hill_strength", "", 0, 2, 0.85, false, "Erosion added where hilliness is 1: more means rougher ranges."},

  {"strata.sets", "", 2, 64, 12, true, "Layer sets of the world: more means more kinds of country before one comes again."},
  {"strata.set_m", "m", 500, 100000, 14000, false, "Wavelength at which layer sets change: more means wider countries of one rock."},
  {"strata.facies_m", "m", 50, 20000, 600, false, "Wavelength at which a layer's rock changes: more means beds that stay of one rock for longer, less means patches."},
  {"strata.deformation_m", "m", 0, 400, 120, false, "How far folds lift and lower the layers, on plains; four times as far in ranges: more bends them more."},
  {"strata.fold_m", "m", 200, 20000, 3500, false, "Wavelength of the largest folds: less means tighter ones."},
  {"strata.tilt_m", "m", 0, 400, 240, false, "How far whole regions of layers tilt: more means steeper dips."},
  {"strata.tilt_wavelength_m", "m", 2000, 100000, 14000, false, "Wavelength of the tilt: less means steeper dips."},
  {"strata.ledge", "", 0, 1.8, 1.7, false, "How far hard layers stand proud: more means higher steps and wider benches, 0 none."},
  {"strata.ledge_slope", "", 0.01, 2, 0.25, false, "Slope of the relief from which ledges show: less terraces gentle hills too."},
  {"strata.district_m", "m", 500, 50000, 5200, false, "Wavelength of districts with and without ledges: more means wider ones."},
  {"strata.resistance", "", 0, 1, 0.7, false, "How much hard rock withstands erosion: more means smooth walls of it, and soft beds between them cut by gullies, 0 wears all rock alike."},

  {"cones.cell_m", "m", 3000, 100000, 8000, false, "Edge of the cells that hold a volcano, seamount or field of cinder cones each: more means rarer ones."},
  {"cones.land_share", "", 0, 1, 0.22, false, "Share of cells on land with cones: more means more volcanoes, 0 none."},
  {"cones.sea_share", "", 0, 1, 0.5, false, "Share of cells on the sea floor with cones: more means more seamounts, 0 none."},
  {"cones.volcano_m", "m", 50, 1500, 850, false, "Height of the tallest volcanoes: more means taller and wider ones."},
  {"cones.seamount_m", "m", 20, 1000, 288, false, "Height of seamounts: more lets the tallest rise from the sea as islands."},
  {"cones.cinder_m", "m", 10, 200, 75, false, "Height of cinder cones: more means taller and wider ones."},

  {"coast.cliff_m", "m", 0, 90, 52, false, "Height of sea cliffs: more means higher walls, 0 leaves every shore as erosion made it."},
  {"coast.cliff_vary_m", "m", 0, 37, 34, false, "How much the height of cliffs varies along a coast: more means higher and lower ones side by side."},
  {"coast.cliff_share", "", 0, 1, 0.65, false, "Share of the hilly coasts that end in cliffs: less leaves more of them to beaches."},
  {"coast.cliff_slope", "", 0.005, 1, 0.07, false, "Slope of the hinterland from which a coast can be a cliff: less lets plains end in cliffs too."},
  {"coast.district_m", "m", 500, 50000, 4500, false, "Wavelength of coasts with and without cliffs: more means longer stretches of one kind."},
  {"coast.fin_m", "m", 0, 15, 11, false, "Amplitude of fins across a cliff coast: more means longer headlands and more stacks, 0 a smooth line."},
  {"coast.fin_wavelength_m", "m", 20, 300, 64, false, "Distance from fin to fin: more means broader headlands and bays."},
  {"coast.joint_m", "m", 0, 1.5, 1.1, false, "Depth of the joints in cliffs: more means stronger buttresses, 0 smooth walls."},
  {"coast.shelf", "", 0.1, 1, 0.6, false, "Share of its depth that the sea floor below cliffs keeps: less means shallower water."},
  {"coast.beach", "", 0, 1, 1, false, "How far gentle shores become beaches with bar, berm and dune foot: less leaves them as erosion made them."},

  {"districts.wavelength_m", "m", 2000, 200000, 15000, false, "Wavelength of districts: more means wider badlands, dunes, tables and karst, further apart."},
  {"districts.border", "", 0.01, 0.5, 0.09, false, "Half width of districts' borders in units of their noise: more means softer borders, less means sudden ones."},
  {"districts.badlands", "", 0, 0.45, 0.15, false, "Share of low dry land that is badlands: more means more of it, 0 none."},
  {"districts.dunes", "", 0, 0.45, 0.12, false, "Share of flat dry land under dunes: more means wider sand seas, 0 leaves none, behind beaches neither."},
  {"districts.mesas", "", 0, 0.45, 0.15, false, "Share of low dry land that is tables and canyons: more means more of it, 0 none."},
  {"districts.karst", "", 0, 0.45, 0.12, false, "Share of low land and shallow sea with karst towers: more means more of it, 0 none."},
  {"districts.glacial", "", 0, 0.45, 0.4, false, "Share of high ranges that glaciers widened: more means more smooth troughs, 0 leaves all valleys sharp."},
  {"districts.badland_hill_m", "m", 0, 300, 120, false, "Height of the hills of badlands: more means taller, steeper ones."},
  {"districts.badland_wavelength_m", "m", 100, 5000, 1000, false, "Wavelength of the hills of badlands: more means broader ones."},
  {"districts.rill_m", "m", 10, 1000, 190, false, "Wavelength of the largest rills in badlands, table land and karst: more means wider gullies, less means a finer texture."},
  {"districts.rill_strength", "", 0, 1, 0.15, false, "Depth of rills as a share of their wavelength: more means deeper ones, 0 none."},
  {"districts.rill_octaves", "", 0, 8, 5, true, "Octaves of rills: more means finer branches, 0 none."},
  {"districts.mesa_m", "m", 0, 800, 220, false, "Height of tables over their canyons: more means higher walls."},
  {"districts.mesa_wavelength_m", "m", 300, 20000, 2800, false, "Wavelength of tables: more means wider plateaus, less means lone buttes."},
  {"districts.canyon_width", "", 0.02, 1, 0.2, false, "Width of canyons in units of their noise: more means wider valleys between tables, less means slots."},
  {"districts.dune_m", "m", 0, 100, 22, false, "Height of large dunes: more means higher and steeper ones."},
  {"districts.dune_wavelength_m", "m", 30, 3000, 260, false, "Wavelength of large dunes: more means wider and gentler ones."},
  {"districts.dune_skew", "", 0, 0.9, 0.55, false, "How much steeper the lee side of a dune is: more means steeper slip faces, 0 makes both sides alike."},
  {"districts.wind_m", "m", 1000, 500000, 24000, false, "Wavelength at which the wind that lays dunes turns: more means straighter sand seas."},
  {"districts.karst_m", "m", 0, 500, 130, false, "Height of karst towers: more means taller, steeper ones."},
  {"districts.karst_cell_m", "m", 30, 3000, 240, false, "Distance of karst towers: more means wider and further ones."},
  {"districts.karst_towers", "", 0, 1, 0.6, false, "Share of places that hold a tower: more makes ridges of them, less leaves lone towers on a plain."},
  {"districts.sink_m", "m", 0, 100, 16, false, "Depth of sinkholes between the towers: more means deeper ones, 0 none."},
});
// clang-format on

}  // namespace talus
