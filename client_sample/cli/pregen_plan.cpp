#include "client_sample/cli/pregen_plan.hpp"

#include <algorithm>
#include <cmath>

namespace talus::cli {
namespace {

/// Columns along the edge of a block.
constexpr std::int64_t kBlockColumns = 8;

std::int32_t chunk_at(double metres, double edge_m) {
  constexpr double kLimit = kChunkLimit;
  return static_cast<std::int32_t>(std::clamp(std::floor(metres / edge_m), -kLimit, kLimit));
}

}  // namespace

std::uint64_t PregenPlan::Square::columns() const {
  return static_cast<std::uint64_t>(std::int64_t{x_high} - x_low + 1) *
         static_cast<std::uint64_t>(std::int64_t{z_high} - z_low + 1);
}

PregenPlan::PregenPlan(const protocol::WorldShape& shape, glm::dvec2 centre, double edge_m, int lod_low, int lod_high)
    : shape_(shape) {
  for (int lod = lod_high; lod >= lod_low; --lod) {
    const double chunk_m = protocol::edge_of(shape, lod);
    const double half = edge_m / 2;
    // The far border itself belongs to the next column.
    const auto last = [&](double high) { return std::nextafter(high, -HUGE_VAL); };
    squares_.push_back({lod, chunk_at(centre.x - half, chunk_m), chunk_at(last(centre.x + half), chunk_m),
                        chunk_at(centre.y - half, chunk_m), chunk_at(last(centre.y + half), chunk_m)});
    columns_ += squares_.back().columns();
  }
  if (!squares_.empty()) {
    block_x_ = squares_.front().x_low;
    block_z_ = squares_.front().z_low;
  }
}

/// Moves on to the next block; false behind the last.
bool PregenPlan::begin_block() {
  in_block_ = 0;
  block_x_ += kBlockColumns;
  if (block_x_ <= squares_[square_].x_high) return true;
  block_x_ = squares_[square_].x_low;
  block_z_ += kBlockColumns;
  if (block_z_ <= squares_[square_].z_high) return true;
  if (++square_ == squares_.size()) return false;
  block_x_ = squares_[square_].x_low;
  block_z_ = squares_[square_].z_low;
  return true;
}

std::optional<PregenPlan::Column> PregenPlan::next() {
  while (square_ < squares_.size()) {
    const Square& square = squares_[square_];
    if (in_block_ == kBlockColumns * kBlockColumns) {
      if (!begin_block()) break;
      continue;
    }
    const std::int64_t x = block_x_ + in_block_ % kBlockColumns;
    const std::int64_t z = block_z_ + in_block_ / kBlockColumns;
    ++in_block_;
    if (x <= square.x_high && z <= square.z_high) {
      return Column{square.lod, static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
    }
  }
  return std::nullopt;
}

std::vector<ChunkKey> PregenPlan::chunks_of(const Column& column) const {
  const double chunk_m = std::ldexp(shape_.cells * shape_.voxel_m, column.lod);
  std::vector<ChunkKey> out;
  const std::int32_t high = chunk_at(shape_.height_range_m.y, chunk_m);
  for (std::int32_t y = chunk_at(shape_.height_range_m.x, chunk_m); y <= high; ++y) {
    out.push_back({column.lod, column.x, y, column.z});
  }
  return out;
}

}  // namespace talus::cli
