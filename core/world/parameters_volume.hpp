// Parameters of a world: what overhangs and what is hollow. Name, unit, limits, default, whole numbers only, meaning.
#pragma once

#include <array>

#include "core/world/manifest.hpp"

namespace talus {

// clang-format off
inline constexpr std::array kVolumeParameters = std::to_array<ParameterInfo>({
  {"warp.reach_m", "m", 0, 6, 4, false, "How far the hardest beds stand out of steep rock: more means deeper overhangs under them, 0 none."},
  {"warp.slope_low", "", 0, 2, 0.25, false, "Slope of the land from which beds begin to stand out: less gives gentle hills a staircase."},
  {"warp.slope_high", "", 0.05, 4, 1, false, "Slope from which they stand out fully: more keeps bold overhangs to cliffs."},
  {"warp.patch_m", "m", 20, 2000, 120, false, "Wavelength of places where more and less of the beds shows: more means longer stretches of each."},

  {"carve.union_m", "m", 0.1, 4, 1.2, false, "Width over which carved spheres flow into each other: more means smoother caves, less shows each sphere."},
  {"carve.blend_m", "m", 0.1, 4, 1.6, false, "Width over which a carved wall rounds into the surface: less leaves sharp rims and crumbs, more softens all."},
  {"carve.roughness_m", "m", 0, 2, 0.7, false, "Roughness of carved walls: more means craggier caves, 0 smooth ones."},

  {"notch.cell_m", "m", 4, 64, 5, false, "Edge of the cells that hold one seed of a notch each: more means fewer notches."},
  {"notch.probability", "", 0, 1, 0.85, false, "Chance that a seed is looked at: more means more notches, 0 none."},
  {"notch.slope_min", "", 0.2, 8, 0.8, false, "Slope that the surface must have at a seed: more keeps notches to steeper walls."},
  {"notch.elevation_low_m", "m", -50, 1500, -0.5, false, "Lowest elevation of a seed: less begins further down."},
  {"notch.elevation_high_m", "m", -50, 1500, 1.8, false, "Highest elevation of a seed: more begins further up."},
  {"notch.radius_low_m", "m", 1, 12, 1.9, false, "Radius of the smallest spheres: more leaves no narrow places."},
  {"notch.radius_high_m", "m", 1, 12, 3.4, false, "Radius of the largest spheres: more means wider halls."},
  {"notch.steps_low", "", 1, 16, 1, true, "Fewest steps of growth from a seed: more means none are shallow."},
  {"notch.steps_high", "", 1, 16, 2, true, "Most steps of growth from a seed: more goes deeper into the rock."},
  {"notch.spheres_low", "", 1, 6, 1, true, "Fewest spheres at each step: more means no single file."},
  {"notch.spheres_high", "", 1, 6, 2, true, "Most spheres at each step: more means wider, more broken walls."},
  {"notch.step_m", "m", 0.5, 8, 1.6, false, "Length of a step: more goes deeper, until spheres no longer touch."},
  {"notch.fall", "", -0.5, 0.5, 0.05, false, "Metres down per metre inwards: more leads down, below 0 up."},
  {"notch.end_radius", "", 0.2, 1.5, 1, false, "Radius of the last step over the first: less means pointed ends, above 1 wide ones."},
  {"notch.jitter", "", 0, 1, 0.6, false, "How far a sphere is displaced, in its radii: more means more irregular shapes."},
  {"notch.stretch", "", 0.3, 2.5, 0.75, false, "Height over width of a sphere: more means taller ones, less flatter ones."},
  {"notch.roof_m", "m", 1, 30, 3, false, "Rock that must stay above: more keeps notches out of thin places."},

  {"caves.cell_m", "m", 4, 64, 26, false, "Edge of the cells that hold one seed of a sea cave each: more means fewer sea caves."},
  {"caves.probability", "", 0, 1, 0.4, false, "Chance that a seed is looked at: more means more sea caves, 0 none."},
  {"caves.slope_min", "", 0.2, 8, 0.9, false, "Slope that the surface must have at a seed: more keeps sea caves to steeper walls."},
  {"caves.elevation_low_m", "m", -50, 1500, 0, false, "Lowest elevation of a seed: less begins further down."},
  {"caves.elevation_high_m", "m", -50, 1500, 4, false, "Highest elevation of a seed: more begins further up."},
  {"caves.radius_low_m", "m", 1, 12, 3.2, false, "Radius of the smallest spheres: more leaves no narrow places."},
  {"caves.radius_high_m", "m", 1, 12, 6.5, false, "Radius of the largest spheres: more means wider halls."},
  {"caves.steps_low", "", 1, 16, 4, true, "Fewest steps of growth from a seed: more means none are shallow."},
  {"caves.steps_high", "", 1, 16, 9, true, "Most steps of growth from a seed: more goes deeper into the rock."},
  {"caves.spheres_low", "", 1, 6, 1, true, "Fewest spheres at each step: more means no single file."},
  {"caves.spheres_high", "", 1, 6, 3, true, "Most spheres at each step: more means wider, more broken walls."},
  {"caves.step_m", "m", 0.5, 8, 3.6, false, "Length of a step: more goes deeper, until spheres no longer touch."},
  {"caves.fall", "", -0.5, 0.5, 0.06, false, "Metres down per metre inwards: more leads down, below 0 up."},
  {"caves.end_radius", "", 0.2, 1.5, 0.55, false, "Radius of the last step over the first: less means pointed ends, above 1 wide ones."},
  {"caves.jitter", "", 0, 1, 0.45, false, "How far a sphere is displaced, in its radii: more means more irregular shapes."},
  {"caves.stretch", "", 0.3, 2.5, 1.25, false, "Height over width of a sphere: more means taller ones, less flatter ones."},
  {"caves.roof_m", "m", 1, 30, 4, false, "Rock that must stay above: more keeps sea caves out of thin places."},

  {"alcoves.cell_m", "m", 4, 64, 26, false, "Edge of the cells that hold one seed of an inland alcove each: more means fewer alcoves."},
  {"alcoves.probability", "", 0, 1, 0.8, false, "Chance that a seed is looked at: more means more alcoves, 0 none."},
  {"alcoves.slope_min", "", 0.2, 8, 1.1, false, "Slope that the surface must have at a seed: more keeps alcoves to steeper walls."},
  {"alcoves.elevation_low_m", "m", -50, 1500, 8, false, "Lowest elevation of a seed: less begins further down."},
  {"alcoves.elevation_high_m", "m", -50, 1500, 420, false, "Highest elevation of a seed: more begins further up."},
  {"alcoves.radius_low_m", "m", 1, 12, 4, false, "Radius of the smallest spheres: more leaves no narrow places."},
  {"alcoves.radius_high_m", "m", 1, 12, 10, false, "Radius of the largest spheres: more means wider halls."},
  {"alcoves.steps_low", "", 1, 16, 1, true, "Fewest steps along the wall from a seed: more means none are narrow."},
  {"alcoves.steps_high", "", 1, 16, 4, true, "Most steps along the wall from a seed: more means wider halls."},
  {"alcoves.spheres_low", "", 1, 6, 2, true, "Fewest spheres at each step: more means no single file."},
  {"alcoves.spheres_high", "", 1, 6, 4, true, "Most spheres at each step: more means wider, more broken walls."},
  {"alcoves.step_m", "m", 0.5, 8, 3, false, "Length of a step, 1.6 times as far along the wall: more goes further, until spheres no longer touch."},
  {"alcoves.fall", "", -0.5, 0.5, 0.02, false, "Metres down from its bed per metre of step_m along the wall: more leads down, below 0 up into the bed."},
  {"alcoves.end_radius", "", 0.2, 1.5, 1, false, "Radius of the last step over the first: less means pointed ends, above 1 wide ones."},
  {"alcoves.jitter", "", 0, 1, 0.8, false, "How far a sphere is displaced, in its radii: more means more irregular shapes."},
  {"alcoves.stretch", "", 0.3, 2.5, 0.6, false, "Height over width of a sphere: more means taller ones, less flatter ones."},
  {"alcoves.roof_m", "m", 1, 30, 3, false, "Rock that must stay above: more keeps alcoves out of thin places."},

  {"arches.cell_m", "m", 4, 64, 12, false, "Edge of the cells that hold one seed of an arch each: more means fewer arches."},
  {"arches.probability", "", 0, 1, 0.95, false, "Chance that a seed is looked at: more means more arches, 0 none."},
  {"arches.slope_min", "", 0.2, 8, 0.7, false, "Slope that the surface must have at a seed: more keeps arches to steeper walls."},
  {"arches.elevation_low_m", "m", -50, 1500, 0, false, "Lowest elevation of a seed: less begins further down."},
  {"arches.elevation_high_m", "m", -50, 1500, 3, false, "Highest elevation of a seed: more begins further up."},
  {"arches.radius_low_m", "m", 1, 12, 4.5, false, "Radius of the smallest spheres: more leaves no narrow places."},
  {"arches.radius_high_m", "m", 1, 12, 9, false, "Radius of the largest spheres: more means wider halls."},
  {"arches.span_m", "m", 10, 66, 60, false, "Longest way under an arch: more lets arches through thicker headlands."},
  {"arches.jitter", "", 0, 1, 0.25, false, "How far a sphere is displaced, in its radii: more means more irregular shapes."},
  {"arches.stretch", "", 0.3, 2.5, 1.6, false, "Height over width of a sphere: more means taller ones, less flatter ones."},
  {"arches.roof_m", "m", 1, 30, 5, false, "Rock that must stay above: more keeps arches out of thin places."},
});
// clang-format on

}  // namespace talus
