// The kernels of the field, each over one row of samples in whole vectors. Private to core/volume; pure.
#pragma once

#include <cstddef>

namespace talus {

/// out = (y - height) * steepness.
void smooth_row(float y_m, const float* height, const float* steepness, std::size_t width, float* out);

/// The same with the surface raised by jut * proud, which fades around a still point: `still2` is the squared distance
/// of the row to the next still point in y and z, still_x the distance along x; null where the row is out of reach.
struct WarpRow {
  const float *height, *steepness, *jut, *proud, *still_x;
  float still2;
};
void warped_row(float y_m, const WarpRow& row, std::size_t width, float* out);

/// distance = smooth minimum of itself and the distance to a sphere's wall, where that is within the band. `dx_m` is
/// the first sample's offset from the centre, `rest2` the squared offset in y and z.
struct SphereRow {
  float dx_m, step_m, rest2, radius_m, union_m;
};
void sphere_row(const SphereRow& row, std::size_t first, std::size_t end, float* distance);

/// Whether any of `width` distances is near enough to a wall to be roughened.
bool any_rough(const float* distance, std::size_t width);

/// What is carved out of a row: distances to the walls, the distance to the next still column along x and z and, along
/// y, to where pillars stand, noise (or null where no sample is near a wall), and the columns' surface with how far it
/// juts (or null where nothing does).
struct CarvedRow {
  const float *distance, *still_x;
  float still_z, still_y;
  const float* noise;
  float roughness_m, blend_m;
  float y_m;
  const float *height, *jut;
};
/// density = smooth maximum of itself and minus the distance to carved space.
void subtract_row(const CarvedRow& row, std::size_t width, float* density);

/// Carved space takes with it what stands out in front of it: the tip of a bed that juts whole counts as this much
/// nearer to the walls than it is, in metres, its root as near as it is. Otherwise tips would stay in the air where
/// the slope that they come from is carved away.
inline constexpr float kFront_m = 1.5f;

/// Radius of the pillars around still columns.
inline constexpr float kPillar_m = 1.1f;

}  // namespace talus
