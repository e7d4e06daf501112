// The worlds that come with the project: deploy/worlds/*.toml.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "core/map/draw_map.hpp"
#include "protocol/manifest_toml.hpp"

namespace talus::protocol {
namespace {

struct Preset {
  std::string stem;
  std::string text;
  Manifest manifest;
};

std::vector<Preset> presets() {
  std::vector<Preset> out;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(TALUS_SOURCE_DIR) / "deploy/worlds")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream file(entry.path());
    Preset preset{entry.path().stem().string(), {std::istreambuf_iterator<char>(file), {}}, {}};
    auto manifest = parse_manifest(preset.text, preset.stem);
    EXPECT_TRUE(manifest) << describe(manifest.error().front());
    if (manifest) preset.manifest = std::move(*manifest);
    out.push_back(std::move(preset));
  }
  return out;
}

TEST(Presets, AreAtLeastFiveSoundWorldsNamedByTheirFiles) {
  const auto all = presets();
  EXPECT_GE(all.size(), 5U);
  std::set<std::uint64_t> seeds;
  for (const Preset& preset : all) {
    EXPECT_EQ(preset.manifest.name, preset.stem);
    EXPECT_TRUE(seeds.insert(preset.manifest.seed).second) << preset.stem << " has the seed of another";
  }
}

TEST(Presets, SayWhatTheyChangeAndChangeIt) {
  for (const Preset& preset : presets()) {
    EXPECT_TRUE(preset.text.starts_with("# ")) << preset.stem;
    EXPECT_GE(std::ranges::count(preset.text, '#'), 4) << preset.stem;
    const Manifest initial;
    int changed = 0;
    for (std::size_t i = 0; i < initial.values.size(); ++i)
      changed += preset.manifest.values[i] != initial.values[i] ? 1 : 0;
    EXPECT_GE(changed, 6) << preset.stem;
  }
}

TEST(Presets, HaveLandAndSeaAndManyColours) {
  for (const Preset& preset : presets()) {
    const WorldFunction world(preset.manifest);
    const MapView view{-65'536, -65'536, 512, 1, 256, 256};
    MapScratch scratch;
    std::vector<std::uint8_t> rgb(std::size_t{3} * 256 * 256);
    draw_map(world, view, {}, scratch, rgb);
    double land = 0;
    for (const float wet : scratch.ground.wet) land += 1.0 - static_cast<double>(wet);
    land /= static_cast<double>(scratch.ground.wet.size());
    EXPECT_GT(land, 0.08) << preset.stem;
    EXPECT_LT(land, 0.97) << preset.stem;
    const auto [low, high] = std::ranges::minmax(scratch.ground.height_m);
    EXPECT_GT(high - low, 300.0F) << preset.stem;
    std::set<std::uint32_t> colours;
    for (std::size_t p = 0; p < rgb.size(); p += 3) {
      colours.insert(std::uint32_t{rgb[p]} << 16 | std::uint32_t{rgb[p + 1]} << 8 | rgb[p + 2]);
    }
    EXPECT_GT(colours.size(), 2000U) << preset.stem;
  }
}

}  // namespace
}  // namespace talus::protocol
