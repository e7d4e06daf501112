// From what plates say to the ground: noises on top of the sums. Pure; private to core/plates.
#pragma once

#include <array>
#include <cstddef>

#include "core/plates/macro_lattice.hpp"
#include "core/plates/macro_nodes.hpp"

namespace talus {

/// The noises that vary the ground.
enum MacroNoise : std::size_t { kUpliftNoise, kArcNoise, kPassNoise, kSwellNoise, kCoastNoise, kMacroNoises };

/// One row of nodes. The channels are changed in place: kUplift becomes the height, kCrest the lift, kBase the floor.
struct GroundRow {
  std::array<NodeArrays, kMacroChannels> channel;
  std::array<NodeArrays, kMacroNoises> noise;
};

void ground_row(const MacroControls& macro, const GroundRow& row, std::size_t width);

}  // namespace talus
