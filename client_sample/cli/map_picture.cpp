#include "client_sample/cli/map_picture.hpp"

#include <algorithm>
#include <cmath>

#include "client_sample/cli/strips.hpp"

namespace talus::cli {
namespace {

/// Rows of the picture that are drawn at a time: memory stays small, and the margins of a strip a tenth of its work.
constexpr int kStripRows = 64;
/// A lattice may be this much coarser than the picture before the next finer one is taken: 64 m for pixels of 62.5 m.
constexpr double kCoarser = 1.05;

/// Which lattice pixels one picture pixel is made of, along one axis.
struct Taps {
  int first = 0;
  std::vector<float> weights;  ///< of first, first + 1 ...; their sum is 1
};

/// Tent filter: as wide as the larger of the two pixels, so neither detail nor blocks show.
Taps taps_at(double centre, double pixels) {
  const double radius = std::max(1.0, pixels);
  Taps out;
  out.first = static_cast<int>(std::ceil(centre - radius));
  float sum = 0;
  for (int i = out.first; static_cast<double>(i) <= centre + radius; ++i) {
    out.weights.push_back(static_cast<float>(1.0 - std::abs(static_cast<double>(i) - centre) / radius));
    sum += out.weights.back();
  }
  for (float& weight : out.weights) weight /= sum;
  return out;
}

/// How a picture lies on its lattice.
struct Fit {
  std::int64_t pixel_voxels = 1;
  glm::i64vec2 corner_voxel{};  ///< of lattice pixel (0, 0)
  glm::dvec2 offset{};          ///< of picture pixel (0, 0)'s centre from lattice pixel (0, 0)'s, in lattice pixels
  double pixels = 1;            ///< lattice pixels along one picture pixel
};

Fit fit_of(const WorldFunction& world, const MapArea& area, int size) {
  const double pixel_voxels = area.edge_m / size / world.voxel_m();
  Fit out;
  while (static_cast<double>(out.pixel_voxels * 2) <= pixel_voxels * kCoarser) out.pixel_voxels *= 2;
  const auto lattice = static_cast<double>(out.pixel_voxels);
  out.pixels = pixel_voxels / lattice;
  for (int axis = 0; axis < 2; ++axis) {
    // In lattice pixels; the picture's first centre is half a picture pixel inside its corner.
    const double corner = (area.centre_m[axis] - area.edge_m / 2) / world.voxel_m() / lattice;
    const double whole = std::floor(corner);
    out.corner_voxel[axis] = static_cast<std::int64_t>(whole) * out.pixel_voxels;
    out.offset[axis] = corner - whole + (out.pixels - 1.0) / 2;
  }
  return out;
}

struct Worker {
  MapScratch scratch;
  std::vector<std::uint8_t> raster;
};

class Drawing {
 public:
  Drawing(const WorldFunction& world, const MapStyle& style, const Fit& fit, Picture& out)
      : world_(world), style_(style), fit_(fit), out_(out) {
    for (int i = 0; i < out.width; ++i) columns_.push_back(taps_at(fit.offset.x + i * fit.pixels, fit.pixels));
    first_column_ = columns_.front().first;
    end_column_ = columns_.back().first + static_cast<int>(columns_.back().weights.size());
  }

  /// Rows first_row..end_row - 1 of the picture.
  void draw_rows(int first_row, int end_row, Worker& worker) const {
    std::vector<Taps> rows;
    for (int k = first_row; k < end_row; ++k) rows.push_back(taps_at(fit_.offset.y + k * fit_.pixels, fit_.pixels));
    MapView view;
    view.pixel_voxels = fit_.pixel_voxels;
    view.samples = fit_.pixel_voxels > 1 ? 2 : 1;
    view.x_voxel = fit_.corner_voxel.x + first_column_ * fit_.pixel_voxels;
    view.z_voxel = fit_.corner_voxel.y + rows.front().first * fit_.pixel_voxels;
    view.width = end_column_ - first_column_;
    view.height = rows.back().first + static_cast<int>(rows.back().weights.size()) - rows.front().first;
    worker.raster.resize(std::size_t{3} * static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    draw_map(world_, view, style_, worker.scratch, worker.raster);
    for (int k = first_row; k < end_row; ++k) {
      const Taps& row = rows[static_cast<std::size_t>(k - first_row)];
      resample_row(worker.raster, view.width, row, row.first - rows.front().first, k);
    }
  }

 private:
  void resample_row(const std::vector<std::uint8_t>& raster, int width, const Taps& row, int from, int k) const {
    std::vector<float> sums(static_cast<std::size_t>(width) * 3, 0.0f);
    for (std::size_t r = 0; r < row.weights.size(); ++r) {
      const std::uint8_t* line = &raster[(static_cast<std::size_t>(from) + r) * sums.size()];
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += row.weights[r] * static_cast<float>(line[i]);
    }
    std::uint8_t* out = &out_.rgb[static_cast<std::size_t>(k) * static_cast<std::size_t>(out_.width) * 3];
    for (const Taps& column : columns_) {
      const float* line = &sums[static_cast<std::size_t>(column.first - first_column_) * 3];
      for (std::size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (std::size_t t = 0; t < column.weights.size(); ++t) sum += column.weights[t] * line[3 * t + c];
        *out++ = static_cast<std::uint8_t>(std::clamp(sum + 0.5f, 0.0f, 255.0f));
      }
    }
  }

  const WorldFunction& world_;
  const MapStyle& style_;
  Fit fit_;
  Picture& out_;
  std::vector<Taps> columns_;
  int first_column_ = 0;
  int end_column_ = 0;
};

}  // namespace

Picture draw_picture(const WorldFunction& world, const MapArea& area, int size, const MapStyle& style) {
  const auto edge = static_cast<std::size_t>(size);
  Picture out{size, size, std::vector<std::uint8_t>(3 * edge * edge)};
  const Drawing drawing(world, style, fit_of(world, area, size), out);
  std::vector<Worker> workers(static_cast<std::size_t>(strip_workers()));
  for_each_strip("map", (size + kStripRows - 1) / kStripRows, [&](int strip, int worker) {
    drawing.draw_rows(strip * kStripRows, std::min(size, (strip + 1) * kStripRows),
                      workers[static_cast<std::size_t>(worker)]);
  });
  return out;
}

}  // namespace talus::cli
