#include "core/strata/formation.hpp"

namespace talus {
namespace {

using enum Material;

// clang-format off
constexpr std::array kFormations = std::to_array<Formation>({
    // Massive limestone with thin shale partings: walls.
    {{{{kLimestone, 0.70f}, {kDolomite, 0.24f}, {kShale, 0.06f}}},
     {{{kShale, 0.66f}, {kMarl, 0.26f}, {kSiltstone, 0.08f}}},
     5.0f, 16.0f, 0.4f, 1.4f, 45.0f, 120.0f},
    // Red beds.
    {{{{kRedSandstone, 0.66f}, {kConglomerate, 0.14f}, {kSiltstone, 0.20f}}},
     {{{kMudstone, 0.72f}, {kSiltstone, 0.22f}, {kRedSandstone, 0.06f}}},
     2.0f, 9.0f, 0.8f, 3.0f, 40.0f, 110.0f},
    // Mud and silt: slopes.
    {{{{kMudstone, 0.62f}, {kSiltstone, 0.26f}, {kShale, 0.12f}}},
     {{{kShale, 0.66f}, {kMudstone, 0.22f}, {kSandstone, 0.12f}}},
     3.0f, 9.0f, 2.0f, 6.0f, 35.0f, 95.0f},
    // Sandstone with marl between: ledges.
    {{{{kSandstone, 0.74f}, {kConglomerate, 0.14f}, {kSiltstone, 0.12f}}},
     {{{kMarl, 0.62f}, {kShale, 0.28f}, {kSandstone, 0.10f}}},
     4.0f, 14.0f, 0.6f, 2.5f, 40.0f, 120.0f},
    // Thin limestone and marl in turns.
    {{{{kLimestone, 0.68f}, {kDolomite, 0.16f}, {kMarl, 0.16f}}},
     {{{kMarl, 0.70f}, {kShale, 0.20f}, {kLimestone, 0.10f}}},
     0.8f, 2.6f, 0.6f, 2.2f, 25.0f, 70.0f},
    // Chalk.
    {{{{kChalk, 0.78f}, {kMarl, 0.14f}, {kLimestone, 0.08f}}},
     {{{kMarl, 0.72f}, {kChalk, 0.28f}, {kChalk, 0.0f}}},
     3.0f, 11.0f, 0.5f, 1.8f, 40.0f, 110.0f},
    // Lava flows and ash.
    {{{{kBasalt, 0.86f}, {kTuff, 0.14f}, {kBasalt, 0.0f}}},
     {{{kTuff, 0.74f}, {kBasalt, 0.20f}, {kMudstone, 0.06f}}},
     8.0f, 26.0f, 2.0f, 7.0f, 50.0f, 140.0f},
    // What lies below everything: granite and what heat made of older rock.
    {{{{kGranite, 0.58f}, {kGneiss, 0.36f}, {kSchist, 0.06f}}},
     {{{kGneiss, 0.56f}, {kSchist, 0.34f}, {kGranite, 0.10f}}},
     12.0f, 30.0f, 6.0f, 14.0f, 50.0f, 140.0f},
});
// clang-format on

}  // namespace

std::span<const Formation> formations() {
  return kFormations;
}

}  // namespace talus
