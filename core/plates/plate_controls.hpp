// What plates and their faults are like; the manifest's [plates] and [macro] sections say what each number does. Pure
// data.
#pragma once

#include <cstdint>

namespace talus {

/// Where plates lie, how they move, and the lines between them.
struct PlateControls {
  double size_m = 16384;     ///< edge of a macro cell, whole metres
  std::int64_t wrap_m = 0;   ///< east-west period, a whole number of 4 size_m; 0 for none
  double jitter = 0.86;      ///< 0..0.9 of the cell
  double big_share = 0.3;    ///< of the squares of 2x2 macro cells that hold one plate instead of four
  double cluster_m = 92000;  ///< wavelength of continents
  double scatter = 0.42;     ///< how much chance, and not the cluster, decides land or sea
  double ocean = 0.53;       ///< continentality below which a plate is oceanic
  double group_speed = 1;    ///< of plates that move together
  double own_speed = 0.25;   ///< of each plate on top
  double wiggle = 0.17;      ///< displacement of a fault as a share of its length
  double wiggle_m = 5200;    ///< wavelength of the displacement's first octave
  double blend_m = 260;      ///< half width over which ownership passes from plate to plate
  std::uint64_t seed = 0;
};

/// Heights and lengths of what plates do to the ground, in metres.
struct MacroControls {
  double land_m = 205;                ///< mean height of land plates
  double land_range_m = 165;          ///< above and below it
  double sea_floor_m = -350;          ///< mean height of oceanic plates
  double sea_range_m = 110;           ///< above and below it
  double collision_m = 1700;          ///< crest where two continents close in at full speed
  double subduction_m = 1270;         ///< crest inland of a trench
  double arc_m = 610;                 ///< crest of island arcs
  double ocean_ridge_m = 230;         ///< crest of mid-ocean ridges
  double rift_m = 300;                ///< shoulders of rift valleys
  double old_fault_m = 350;           ///< crest of the highest hills along faults at rest
  double trench_m = 330;              ///< depth of trenches below the sea floor
  double range_width = 1;             ///< scale of the width of everything along faults
  double shelf_m = 6000;              ///< from the fault to where the coastal plain ends
  double shelf_depth_m = 150;         ///< depth at the fault between land and sea
  double continental_slope_m = 3200;  ///< from the shelf's edge to the sea floor
  double uplift_noise = 0.6;          ///< how unevenly ranges rise
  double pass_depth = 0.5;            ///< how deep valleys cut through ranges
  double pass_m = 9000;               ///< wavelength of those valleys
  double swell_m = 75;                ///< amplitude of broad rises
  double coast_m = 125;               ///< amplitude of what makes bays and headlands
  double coast_wavelength_m = 6000;
  std::uint64_t seed = 0;
};

}  // namespace talus
