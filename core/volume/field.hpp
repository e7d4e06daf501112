// Density of columns with what warp adds and carving takes away, row by row: the only place where it is computed. Pure;
// memory is the caller's.
//
// Rock is negative. A row is all samples of a grid along x at one y and z. Every sample is a function of its column,
// its position and the spheres that reach it, in one order of operations whatever the row, so that a lattice point has
// the same bits in every box that holds it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/axis.hpp"
#include "core/grid/column_grid.hpp"
#include "core/strata/hardness_profile.hpp"
#include "core/volume/carve_spheres.hpp"
#include "core/volume/controls.hpp"

namespace talus {

/// A grid of columns as the field reads it: arrays of sample_count(grid) floats, rows of row_stride(grid).
struct FieldColumns {
  ColumnGrid grid;
  const float* height_m;
  const float* steepness;  ///< 1 / sqrt(1 + slope^2)
  const float* jut_m;      ///< of warp_columns, or null where nothing juts
  const float *stack_m, *choice;
  std::span<const CarveSphere> spheres;  ///< of gather_spheres
};

/// Octaves of the roughness of carved walls: wavelengths of 4 m and 2 m, of amplitudes 1 and 0.5.
inline constexpr std::size_t kRoughOctaves = 2;

struct FieldMemory {
  struct Octave {
    Axis x, z;
  };
  std::array<Octave, kRoughOctaves> rough;
  std::array<Axis, kRoughOctaves> rough_y;  ///< one sample: the layer's
  /// Distance of each column to the next still column along x.
  std::array<float, kColumnsMax + kRowPadding> still_x;
  std::array<float, kColumnsMax + kRowPadding> proud, noise, carve;
  std::vector<std::uint32_t> layer_spheres;  ///< those that reach the layer at hand
};

class Field {
 public:
  /// All must outlive this.
  Field(const HardnessProfile& profile, const CarveControls& controls, const FieldColumns& columns,
        FieldMemory& memory);

  /// Chooses the layer that row() samples.
  void layer(std::int64_t y_voxel);
  /// Writes grid.width densities of row `k`, rounded up to whole vectors.
  void row(int k, float* out) { part(k, 0, width_, out); }
  /// Writes those of samples `first` .. `end` - 1 alone, out[0] being the row's first; `first` is a multiple of
  /// kRowPadding.
  void part(int k, std::size_t first, std::size_t end, float* out);

 private:
  /// The part of a row that is being written.
  struct Span {
    std::size_t first, end;
    std::size_t size() const { return end - first; }
  };
  bool carve_row(int k, const CarveSphere& sphere, const Span& span);
  void base_row(int k, const Span& span, float* out);
  const float* rough_row(int k, const Span& span);

  const HardnessProfile& profile_;
  const CarveControls& controls_;
  const FieldColumns& columns_;
  FieldMemory& memory_;
  std::size_t stride_;
  std::size_t width_;
  float step_m_;
  float y_m_ = 0;
  float still_y_ = 0;
};

}  // namespace talus
