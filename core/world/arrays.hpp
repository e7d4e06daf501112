// Workspace of one call of WorldFunction::columns. Private to core/world.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/base/check.hpp"
#include "core/landforms/district.hpp"

namespace talus {

/// Cuts one vector of floats into the arrays of a grid. Sized once, so arrays stay where they are.
class Arrays {
 public:
  Arrays(std::vector<float>& memory, std::size_t count, std::size_t arrays) : count_(count) {
    memory.resize(std::max(memory.size(), count * arrays));
    next_ = memory.data();
    end_ = next_ + count * arrays;
  }
  /// The same memory from its next array on, for a smaller grid.
  Arrays(const Arrays& other, std::size_t count) : count_(count), next_(other.next_), end_(other.end_) {}
  float* take(std::size_t arrays = 1) { return std::exchange(next_, next_ + arrays * count_); }
  std::span<float> span(float* array, std::size_t arrays = 1) const { return {array, arrays * count_}; }
  JetArrays jet() { return {span(take()), span(take()), span(take())}; }
  /// The next `arrays` arrays, for a stage that keeps nothing in them: the next taker gets the same.
  std::span<float> borrow(std::size_t arrays) const {
    TALUS_CHECK(next_ + arrays * count_ <= end_);
    return {next_, arrays * count_};
  }

 private:
  std::size_t count_;
  float* next_;
  float* end_;
};

}  // namespace talus
