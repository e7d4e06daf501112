// The columns that recent chunks stand on. Chunks stacked in y stand on the same columns, which are half of the work of
// a fresh chunk: at LOD 0 about eight chunks share one footprint, seven of them air or rock.
//
// Bounded in blocks (about 48 KiB each at 32 cells), the longest unused forgotten first. Two threads that miss the same
// footprint at once both evaluate it; the values are the same. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "core/world/world_function.hpp"

namespace talus::server {

struct ColumnName {
  std::uint32_t world = 0;
  std::int32_t lod = 0;
  std::int32_t x = 0;
  std::int32_t z = 0;
  friend bool operator==(const ColumnName&, const ColumnName&) = default;
};

class ColumnMemo {
 public:
  explicit ColumnMemo(std::size_t blocks_max) : blocks_max_(blocks_max) {}

  /// Copies the columns of `name` to `out`, reusing its memory. False when they are not known.
  bool load(const ColumnName& name, ColumnBlock& out);
  /// Copies the values of `columns`; its working memory stays with it.
  void store(const ColumnName& name, const ColumnBlock& columns);
  std::size_t blocks() const;

 private:
  struct Hash {
    std::size_t operator()(const ColumnName& name) const noexcept;
  };
  using Block = std::shared_ptr<const ColumnBlock>;
  using Order = std::list<std::pair<ColumnName, Block>>;

  const std::size_t blocks_max_;
  mutable std::mutex mutex_;
  Order order_;  ///< newest first
  std::unordered_map<ColumnName, Order::iterator, Hash> places_;
};

}  // namespace talus::server
