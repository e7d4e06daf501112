#include "core/world/manifest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace talus {
namespace {

TEST(Manifest, StartsWithoutFaults) {
  EXPECT_TRUE(manifest_faults(Manifest()).empty());
}

TEST(Manifest, NamesEveryParameterOnceWithLimitsAroundItsDefault) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info : manifest_parameters()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_LE(info.low, info.initial) << info.name;
    EXPECT_LE(info.initial, info.high) << info.name;
    EXPECT_LT(info.low, info.high) << info.name;
    EXPECT_NE(info.name.find('.'), std::string_view::npos) << info.name;
    EXPECT_NE(info.meaning.find(':'), std::string_view::npos) << info.name << " says nothing of more and less";
    if (info.unit == "m") {
      EXPECT_TRUE(info.name.ends_with("_m")) << info.name;
    }
  }
}

TEST(Manifest, RefusesEveryValueOutsideItsLimits) {
  const auto parameters = manifest_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double wide = parameters[i].high - parameters[i].low;
    for (const double bad :
         {parameters[i].low - wide, parameters[i].high + wide, std::nan(""), std::numeric_limits<double>::infinity()}) {
      Manifest manifest;
      manifest.values[i] = bad;
      const auto faults = manifest_faults(manifest);
      ASSERT_EQ(faults.size(), 1U) << parameters[i].name;
      EXPECT_EQ(faults[0].parameter, parameters[i].name);
    }
  }
}

TEST(Manifest, RefusesFractionsOfWholeNumbersAndContradictions) {
  const auto faults_with = [](std::string_view name, double value) {
    Manifest manifest;
    manifest.values[parameter_index(name)] = value;
    return manifest_faults(manifest);
  };
  EXPECT_EQ(faults_with("erosion.octaves", 2.5).size(), 1U);
  EXPECT_EQ(faults_with("chunk.cells", 24).size(), 1U);
  EXPECT_EQ(faults_with("chunk.voxel_m", 0.75).size(), 1U);
  EXPECT_TRUE(faults_with("chunk.voxel_m", 0.5).empty());
}

TEST(Manifest, RefusesNamesThatWouldNotSurviveAnAddress) {
  for (const char* name : {"", "Alps", "a b", "../etc", "a/b", "é", "a23456789012345678901234567890123"}) {
    Manifest manifest;
    manifest.name = name;
    EXPECT_FALSE(manifest_faults(manifest).empty()) << name;
  }
}

TEST(Manifest, HasOtherBytesForEveryOtherValue) {
  std::set<std::vector<std::byte>> seen;
  Manifest manifest;
  EXPECT_TRUE(seen.insert(canonical_bytes(manifest)).second);
  manifest.seed ^= 1;
  EXPECT_TRUE(seen.insert(canonical_bytes(manifest)).second);
  for (std::size_t i = 0; i < manifest.values.size(); ++i) {
    Manifest other;
    other.values[i] = std::nextafter(other.values[i], 1e9);
    EXPECT_TRUE(seen.insert(canonical_bytes(other)).second) << manifest_parameters()[i].name;
  }
}

TEST(Manifest, CannotTellItsTwoZeros) {
  Manifest positive;
  Manifest negative;
  const std::size_t index = parameter_index("erosion.offset");
  positive.values[index] = 0.0;
  negative.values[index] = -0.0;
  EXPECT_EQ(canonical_bytes(positive), canonical_bytes(negative));
}

}  // namespace
}  // namespace talus
