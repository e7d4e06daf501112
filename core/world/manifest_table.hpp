// The table of every world parameter: name, unit, limits, default, whole numbers only, meaning. Order is canonical.
#pragma once

#include <array>

#include "core/world/manifest.hpp"

namespace talus {

// clang-format off
inline constexpr std::array kManifestTable = std::to_array<ParameterInfo>({
  {"chunk.cells", "cells", 16, 32, 32, true, "Cells along a chunk's edge, 16 or 32: more means fewer and larger payloads."},
  {"chunk.voxel_m", "m", 0.25, 4, 1, false, "Edge of a LOD 0 cell, a power of two: less means finer terrain and more chunks."},

  {"plates.size_m", "m", 4096, 131072, 16384, true, "Edge of the cell that holds a plate: more means larger plates, longer ranges and wider plains."},
  {"plates.jitter", "", 0, 0.9, 0.86, false, "How far plates stray from a square grid: more means plates of many shapes, less means squares."},
  {"plates.big_share", "", 0, 1, 0.3, false, "Share of 2x2 cells that hold one plate instead of four: more means more large plates among small ones."},
  {"plates.continent_m", "m", 4000, 1000000, 92000, false, "Wavelength of continents and oceans: more means plates of a kind keep together over longer distances."},
  {"plates.scatter", "", 0, 2, 0.42, false, "How much chance makes land or sea of a single plate: more means inland seas and lone islands, less means compact continents."},
  {"plates.ocean", "", 0.05, 0.95, 0.53, false, "Where between land and sea the line is drawn: more means more sea, less means more land."},
  {"plates.group_speed", "", 0, 3, 1, false, "Speed of plates that move together: more means higher ranges and deeper rifts between groups, less leaves hills."},
  {"plates.own_speed", "", 0, 3, 0.25, false, "Speed of each plate within its group: more means ranges around single plates, less means calm interiors."},
  {"plates.wiggle", "", 0, 0.4, 0.17, false, "How far a fault strays from a straight line, as a share of its length: more means winding coasts and ranges."},
  {"plates.wiggle_m", "m", 500, 50000, 5200, false, "Wavelength of a fault's largest bends: more means long curves, less means zigzags."},
  {"plates.blend_m", "m", 20, 350, 260, false, "Half width over which one plate's ground passes into the next one's: more softens faults and vertices, less sharpens them."},

  {"macro.land_m", "m", 20, 1500, 205, false, "Mean height of continental plates: more means higher plains and steeper coastal plains."},
  {"macro.land_range_m", "m", 0, 600, 165, false, "How far continental plates lie above and below that: more means uplands and lowlands, and lakes where they sink."},
  {"macro.sea_floor_m", "m", -2000, -50, -350, false, "Mean height of oceanic plates: less means deeper seas and steeper continental slopes."},
  {"macro.sea_range_m", "m", 0, 500, 110, false, "How far oceanic plates lie above and below that: more means shallow and deep basins side by side."},
  {"macro.collision_m", "m", 0, 4000, 1700, false, "Crest where two continents close in at full speed: more means higher mountains."},
  {"macro.subduction_m", "m", 0, 4000, 1270, false, "Crest of ranges along coasts under which sea floor dives: more means higher mountains near the sea."},
  {"macro.arc_m", "m", 0, 2000, 610, false, "Crest of island arcs above the sea floor: more means larger islands, less leaves shoals."},
  {"macro.ocean_ridge_m", "m", 0, 1000, 230, false, "Height of ridges where sea floor parts: more means shallower ridges."},
  {"macro.rift_m", "m", 0, 1500, 300, false, "Height of shoulders and depth of valleys where continents part: more means deeper rift lakes."},
  {"macro.old_fault_m", "m", 0, 2000, 350, false, "Height of the highest hills along faults at rest: more means old mountains inland, less means plains."},
  {"macro.trench_m", "m", 0, 2000, 330, false, "Depth of trenches where sea floor dives: more means deeper ones."},
  {"macro.range_width", "", 0.3, 3, 1, false, "Scale of the width of all that lies along faults: more means broad massifs with gentle flanks, less means narrow steep ones."},
  {"macro.shelf_m", "m", 1000, 50000, 6000, false, "Width of shelf and coastal plain from the fault inland: more means gentle coasts and wide shelves."},
  {"macro.shelf_depth_m", "m", 20, 1000, 150, false, "Depth at the outer edge of the shelf: more moves the shore inland."},
  {"macro.continental_slope_m", "m", 500, 20000, 3200, false, "Width of the slope from shelf to sea floor: more means a gentler fall."},
  {"macro.uplift_noise", "", 0, 0.75, 0.5, false, "How unevenly ranges rise along their crests: more means single massifs with gaps, less means walls."},
  {"macro.pass_depth", "", 0, 0.9, 0.45, false, "Depth of valleys that cross ranges, as a share of the range: more means low passes, 0 none."},
  {"macro.pass_wavelength_m", "m", 1000, 50000, 9000, false, "Wavelength of those valleys: more means they are wider and further apart."},
  {"macro.swell_m", "m", 0, 500, 75, false, "Amplitude of broad rises and hollows of the land: more means rolling uplands and more lakes."},
  {"macro.coast_m", "m", 0, 500, 125, false, "Amplitude of the noise that shapes the coast: more means bays, skerries and drowned valleys, less means smooth shores."},
  {"macro.coast_wavelength_m", "m", 500, 50000, 6000, false, "Largest wavelength of that noise: more means larger bays."},

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
  {"erosion.fade_altitude", "", 0, 2, 0.55, false, "How much altitude decides what is peak and what is valley: more sharpens peaks and valley floors."},
  {"erosion.fade_relief", "", 0, 2, 0.75, false, "How much the hills decide what is peak and what is valley: more gives each hill its own peak."},
  {"erosion.plain_strength", "", 0, 1, 0.06, false, "Erosion where hilliness is 0: more engraves plains."},
  {"erosion.hill_strength", "", 0, 2, 0.85, false, "Erosion added where hilliness is 1: more means rougher ranges."},

  {"strata.sets", "", 2, 64, 12, true, "Layer sets of the world: more means more kinds of country before one comes again."},
  {"strata.set_m", "m", 500, 100000, 9000, false, "Wavelength at which layer sets change: more means wider countries of one rock."},
  {"strata.deformation_m", "m", 0, 400, 120, false, "How far folds lift and lower the layers: more bends them more."},
  {"strata.fold_m", "m", 200, 20000, 3500, false, "Wavelength of the largest folds: less means tighter ones."},
  {"strata.tilt_m", "m", 0, 400, 240, false, "How far whole regions of layers tilt: more means steeper dips."},
  {"strata.tilt_wavelength_m", "m", 2000, 100000, 14000, false, "Wavelength of the tilt: less means steeper dips."},
  {"strata.ledge", "", 0, 1.8, 1.5, false, "How far hard layers stand proud: more means higher steps and wider benches, 0 none."},
  {"strata.ledge_slope", "", 0.01, 2, 0.25, false, "Slope of the relief from which ledges show: less terraces gentle hills too."},
  {"strata.district_m", "m", 500, 50000, 5200, false, "Wavelength of districts with and without ledges: more means wider ones."},
  {"strata.resistance", "", 0, 1, 0.4, false, "How much hard rock withstands erosion: more means shallower gullies in it."},

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

  {"micro.wavelength_m", "m", 5, 500, 60, false, "Largest wavelength of the roughness on top: more means larger lumps."},
  {"micro.octaves", "", 0, 6, 4, true, "Octaves of roughness: more means detail down to the voxel."},
  {"micro.base_m", "m", 0, 5, 0.4, false, "Amplitude of roughness on plains: more means bumpier meadows."},
  {"micro.hill_m", "m", 0, 10, 2.4, false, "Amplitude of roughness added where hilliness is 1: more means rougher rock."},

  {"cover.snow_line_m", "m", -500, 5000, 1050, false, "Height above which snow lies on gentle ground: less means whiter mountains."},
  {"cover.grass_line_m", "m", -500, 5000, 850, false, "Height up to which grass grows: less means barer mountains."},
  {"cover.beach_m", "m", 0, 50, 4, false, "Height up to which gentle shores are sand: more means wider beaches."},
  {"cover.rock_slope", "", 0.1, 4, 1.1, false, "Slope (tangent) from which rock is bare: less means barer flanks."},
});
// clang-format on

}  // namespace talus
