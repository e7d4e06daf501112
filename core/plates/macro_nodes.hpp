// The sums over plates at the nodes of the macro lattice. Pure; private to core/plates.
#pragma once

#include <array>
#include <cstddef>

#include "core/plates/plate.hpp"

namespace talus {

/// Nodes are summed in groups of 4 x 4: a group is a vector of the widest processor, and compact, so that few plates
/// touch it.
inline constexpr int kGroupEdge = 4;
inline constexpr std::size_t kGroupNodes = 16;
/// Below this share a plate has no part in a node, and its part grows from nothing there. The logistic is this small
/// 20.7 blend widths beyond a fault.
inline constexpr float kShareMin = 1e-9f;
inline constexpr float kShareReach = 20.8f;

/// Positions in whole metres from the group's origin.
struct NodeGroup {
  alignas(64) std::array<float, kGroupNodes> x;
  alignas(64) std::array<float, kGroupNodes> z;
};

/// A value and its slopes at the nodes of a group.
struct GroupJet {
  alignas(64) std::array<float, kGroupNodes> v{};
  alignas(64) std::array<float, kGroupNodes> x{};
  alignas(64) std::array<float, kGroupNodes> z{};
};

/// What plates say about the ground, before noises.
enum MacroChannel : std::size_t { kBase, kUplift, kArc, kCrest, kHilly, kMacroChannels };

/// Sums of shares, and of shares times values.
struct GroupSums {
  GroupJet share;
  std::array<GroupJet, kMacroChannels> channel;
};

struct ShelfTerms {
  float per_shelf = 0;  ///< 1 / (shelf's width)
  float slope_m = 0;
  float shelf_depth_m = 0;
};

/// A plate and where its site lies from the group's origin, in whole metres.
struct PlacedPlate {
  const Plate* plate;
  glm::i64vec2 site_from_origin;
};

/// Whether the plate can have a share anywhere in the box `low`..`high` (metres from the origin). Never a wrong no.
bool can_share(const PlacedPlate& placed, const glm::dvec2& low, const glm::dvec2& high);

/// Adds a plate's share and values. Plates that have no share change no bit.
///
/// Share: the product of logistics of the distances inside each fault; never 0 for all plates at once, not even where a
/// curve bends around a vertex. Value: the mean over the plate's faults, weighted by inverse distance that stays finite
/// on them, so each fault's profile holds at it and all meet smoothly at vertices.
void add_plate(const PlacedPlate& placed, const ShelfTerms& coast, const NodeGroup& group, GroupSums& sums);

/// Divides the channels by the share.
void finish_group(GroupSums& sums);

}  // namespace talus
