// Which columns of chunks `talus pregen` asks for, in which order: coarse LODs first, and within one LOD in blocks, so
// that columns which share ground are made soon after each other. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "core/grid/chunk_key.hpp"
#include "protocol/interest_area.hpp"

namespace talus::cli {

class PregenPlan {
 public:
  struct Column {
    std::int32_t lod = 0;
    std::int32_t x = 0;
    std::int32_t z = 0;
    friend bool operator==(const Column&, const Column&) = default;
  };

  /// Every column of `lod_high` down to `lod_low` that meets the square of `edge_m` around `centre`, within the world.
  PregenPlan(const protocol::WorldShape& shape, glm::dvec2 centre, double edge_m, int lod_low, int lod_high);

  std::uint64_t columns() const { return columns_; }
  /// The next column, or nothing behind the last.
  std::optional<Column> next();
  /// Its chunks between the world's heights, from below.
  std::vector<ChunkKey> chunks_of(const Column& column) const;

 private:
  /// Columns of one LOD, both ends included.
  struct Square {
    std::int32_t lod = 0;
    std::int32_t x_low = 0, x_high = 0, z_low = 0, z_high = 0;
    std::uint64_t columns() const;
  };
  bool begin_block();

  protocol::WorldShape shape_;
  std::vector<Square> squares_;
  std::uint64_t columns_ = 0;
  std::size_t square_ = 0;
  std::int64_t block_x_ = 0;  ///< lowest corner of the present block
  std::int64_t block_z_ = 0;
  std::uint32_t in_block_ = 0;
};

}  // namespace talus::cli
