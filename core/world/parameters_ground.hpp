// Parameters of a world: the lattice, plates, and the large forms along their faults.
// Name, unit, limits, default, whole numbers only, meaning.
#pragma once

#include <array>

#include "core/world/manifest.hpp"

namespace talus {

// clang-format off
inline constexpr std::array kGroundParameters = std::to_array<ParameterInfo>({
  {"chunk.cells", "cells", 16, 32, 32, true, "Cells along a chunk's edge, 16 or 32: more means fewer and larger payloads."},
  {"chunk.voxel_m", "m", 0.25, 4, 1, false, "Edge of a LOD 0 cell, a power of two: less means finer terrain and more chunks."},

  {"world.wrap_m", "m", 0, 1e9, 0, false, "East-west period after which the world repeats, a multiple of 131072 m; 0 for none: more means a wider way around it, less lets one come home sooner."},

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
});
// clang-format on

}  // namespace talus
