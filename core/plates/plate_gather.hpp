// Which plates can have a part in the ground of a box. Pure; private to core/plates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "core/plates/plate.hpp"

namespace talus {

/// The plates near one region, remembered for the next box inside it. Never part of a value.
class PlateGather {
 public:
  /// Sites of every plate that can have a share in the box `low`..`high` (whole metres), in the order of their keys,
  /// and some that have none. Valid until the next call.
  const std::vector<Site>& near(const PlateBuilder& builder, const glm::i64vec2& low_m, const glm::i64vec2& high_m);

 private:
  /// The sites of one square, as PlateSites::add_sites gave them lately.
  struct Square {
    glm::i64vec2 at{};
    std::uint64_t builder = 0;
    std::size_t count = 0;  ///< 0: none known, as every square has a site
    std::array<Site, 4> sites;
  };
  static constexpr std::size_t kSquaresEdge = 16;

  void fill(const PlateBuilder& builder);
  void add_sites(const PlateBuilder& builder, const glm::i64vec2& square);

  bool known_ = false;
  std::uint64_t builder_ = 0;
  glm::i64vec2 low_m_{};
  glm::i64vec2 high_m_{};
  std::vector<Site> sites_;
  std::vector<Site> around_;
  std::vector<Square> squares_;  ///< by the low bits of their place
};

}  // namespace talus
