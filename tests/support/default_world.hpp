// The world without a manifest of its own, made once a process.
#pragma once

#include "core/world/world_function.hpp"

namespace talus::test {

inline const WorldFunction& world() {
  static const WorldFunction one{Manifest()};
  return one;
}

}  // namespace talus::test
