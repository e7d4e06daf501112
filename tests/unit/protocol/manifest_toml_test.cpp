#include "protocol/manifest_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include <nlohmann/json.hpp>

#include "core/grid/chunk_key.hpp"
#include "core/strata/material.hpp"
#include "core/world/world_function.hpp"
#include "protocol/limits.hpp"

namespace talus::protocol {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> faults_of(std::string_view text) {
  const auto manifest = parse_manifest(text, "alps.toml");
  std::vector<std::string> out;
  if (manifest) return out;
  for (const TextFault& fault : manifest.error()) out.push_back(describe(fault));
  return out;
}

TEST(ManifestToml, OfNothingIsTheDefaultWorld) {
  EXPECT_EQ(*parse_manifest("", "x"), Manifest{});
}

TEST(ManifestToml, ReadsNameSeedAndParameters) {
  const auto manifest = parse_manifest("name = \"alps\"\nseed = 0x10\n[erosion]\ngain = 0.25\noctaves = 3\n", "x");
  ASSERT_TRUE(manifest);
  EXPECT_EQ(manifest->name, "alps");
  EXPECT_EQ(manifest->seed, 16U);
  EXPECT_EQ(parameter(*manifest, "erosion.gain"), 0.25);
  EXPECT_EQ(parameter(*manifest, "erosion.octaves"), 3);
}

TEST(ManifestToml, GivesBackWhatItFormats) {
  std::mt19937_64 random(20261122);
  for (int round = 0; round < 8; ++round) {
    Manifest manifest;
    manifest.name = "w-" + std::to_string(round);
    manifest.seed = round == 0 ? std::numeric_limits<std::uint64_t>::max() : random();
    const auto parameters = manifest_parameters();
    std::size_t changed = 0;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].whole) continue;
      const double before = manifest.values[i];
      manifest.values[i] = std::uniform_real_distribution<double>(parameters[i].low, parameters[i].high)(random);
      // What contradicts the others, as a least value above its largest does, is not taken.
      const bool is_sound = manifest_faults(manifest).empty();
      if (!is_sound) manifest.values[i] = before;
      if (is_sound) ++changed;
    }
    EXPECT_GT(changed, parameters.size() / 2);
    const auto again = parse_manifest(format_manifest(manifest), "again.toml");
    ASSERT_TRUE(again) << describe(again.error().front());
    EXPECT_EQ(*again, manifest);
  }
}

TEST(ManifestToml, ReportsEveryFaultWithItsLine) {
  EXPECT_THAT(faults_of("[erosion]\ngain = 3\ngian = 0.5\noctaves = 2.5\nstrength = \"big\"\n\n[erosoin]\ngain = 1\n"),
              ElementsAre("alps.toml:2: erosion.gain: 3 is out of range, allowed 0.1..0.9",
                          "alps.toml:3: erosion.gian: unknown key, did you mean erosion.gain?",
                          "alps.toml:4: erosion.octaves: is a number with a fraction, wanted a whole number",
                          "alps.toml:5: erosion.strength: is a text, wanted a number",
                          "alps.toml:7: erosoin: unknown section, did you mean [erosion]?"));
}

TEST(ManifestToml, RefusesEveryParameterOutOfRangeOfTheWrongTypeAndMistypedWithLineKeyAndRange) {
  for (const ParameterInfo& info : manifest_parameters()) {
    const std::string section(info.name.substr(0, info.name.find('.')));
    const std::string key(info.name.substr(section.size() + 1));
    const auto fault = [&](const std::string& line) {
      const auto faults = faults_of("[" + section + "]\n" + line + "\n");
      return faults.size() == 1 ? faults.front() : std::to_string(faults.size()) + " faults";
    };
    const std::string place = "alps.toml:2: " + std::string(info.name);
    const std::string range = "allowed " + format_number(info.low) + ".." + format_number(info.high);
    for (const double bad : {info.low - 1, info.high + 1}) {
      const std::string text = fault(key + " = " + format_number(bad));
      EXPECT_THAT(text, testing::AllOf(testing::StartsWith(place), testing::EndsWith(range))) << info.name;
    }
    EXPECT_EQ(fault(key + " = true"),
              place + ": is true or false, wanted a " + (info.whole ? "whole number" : "number"));
    const auto mistyped = fault(key + "x = 1");
    EXPECT_THAT(mistyped, HasSubstr("unknown key, did you mean " + section + ".")) << info.name;
  }
}

TEST(ManifestToml, NamesTheSectionsWhenNoneIsNear) {
  EXPECT_THAT(faults_of("[zzz]\n"), ElementsAre(HasSubstr("known are [chunk] [world] [plates]")));
}

TEST(ManifestToml, RefusesNumbersThatAreNone) {
  EXPECT_THAT(faults_of("[erosion]\ngain = nan\n"), ElementsAre(HasSubstr("nan is out of range")));
  EXPECT_THAT(faults_of("[erosion]\ngain = -inf\n"), ElementsAre(HasSubstr("-inf is out of range")));
  EXPECT_THAT(faults_of("[erosion]\ngain = 1e300\n"), ElementsAre(HasSubstr("is out of range")));
}

TEST(ManifestToml, SaysWhereTheSyntaxBreaks) {
  EXPECT_THAT(faults_of("name = \"x\"\nseed =\n"), ElementsAre(HasSubstr("alps.toml:2: ")));
  EXPECT_THAT(faults_of("name = \"a\"\nname = \"b\"\n"), ElementsAre(HasSubstr("alps.toml:2: ")));
  EXPECT_THAT(faults_of("name = \"\xFF\"\n"), ElementsAre(HasSubstr("alps.toml:1: ")));
}

TEST(ManifestToml, RefusesNamesThatAUrlCannotHold) {
  EXPECT_THAT(faults_of("name = \"../etc\"\n"), ElementsAre(HasSubstr("alps.toml:1: name: ")));
  EXPECT_THAT(faults_of("name = \"\"\n"), ElementsAre(HasSubstr("alps.toml:1: name: ")));
  EXPECT_THAT(faults_of("name = 3\n"), ElementsAre(HasSubstr("wanted a text in quotes")));
  EXPECT_THAT(faults_of("[name]\nx = 3\n"), ElementsAre(HasSubstr("is a section, wanted a text")));
}

TEST(ManifestToml, RefusesSeedsOutsideSixtyFourBits) {
  for (const char* text : {"seed = -1", "seed = 1.5", "seed = \"18446744073709551616\"", "seed = \"+1\"", "seed = \"\"",
                           "seed = \" 1\"", "seed = true"}) {
    EXPECT_THAT(faults_of(text), ElementsAre(HasSubstr("alps.toml:1: seed: "))) << text;
  }
  EXPECT_THAT(faults_of("seed = \"18446744073709551615\""), IsEmpty());
}

TEST(ManifestToml, ReportsContradictionsAtTheirLine) {
  EXPECT_THAT(faults_of("[chunk]\n\nvoxel_m = 0.75\n"), ElementsAre(HasSubstr("alps.toml:3: chunk.voxel_m: ")));
}

TEST(ManifestToml, RefusesTextsThatAreTooLong) {
  EXPECT_THAT(faults_of(std::string(kTomlBytesMax + 1, ' ')), ElementsAre("alps.toml: the file is longer than 1 MiB"));
}

TEST(ManifestToml, ListsOnlySoManyFaults) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "k" + std::to_string(i) + " = 1\n";
  const auto faults = faults_of(text);
  EXPECT_EQ(faults.size(), kTomlFaultsMax + 1);
  EXPECT_EQ(faults.back(), "alps.toml: and 436 more faults");
}

TEST(ManifestToml, SurvivesNestingWithoutEnd) {
  EXPECT_FALSE(parse_manifest("x = " + std::string(100'000, '['), "x"));
  EXPECT_FALSE(parse_manifest("x = " + std::string(5'000, '[') + std::string(5'000, ']'), "x"));
}

TEST(WorldHash, IsSha256OfTheCanonicalBytesAndMovesWithEveryField) {
  const Manifest initial;
  const std::string hash = world_hash(initial);
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  Manifest other = initial;
  other.seed ^= 1;
  EXPECT_NE(world_hash(other), hash);
  other = initial;
  other.values.back() += 1e-9;
  EXPECT_NE(world_hash(other), hash);
  other = initial;
  other.name = "another";
  EXPECT_NE(world_hash(other), hash);
}

TEST(ManifestJson, HasEveryFieldAClientMayRelyOn) {
  Manifest manifest;
  manifest.seed = std::numeric_limits<std::uint64_t>::max();
  const std::string text = manifest_json(manifest);
  EXPECT_LT(text.size(), kManifestJsonBytesMax);
  const auto json = nlohmann::json::parse(text);
  for (const char* field :
       {"name", "seed", "world_hash", "generator_version", "chunk_cells", "voxel_m", "lod_max", "chunk_limit",
        "sea_level_m", "height_range_m", "materials", "formats", "limits", "parameters"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  EXPECT_EQ(json["seed"], "18446744073709551615");
  EXPECT_EQ(json["world_hash"], world_hash(manifest));
  EXPECT_EQ(json["chunk_limit"], kChunkLimit);
  EXPECT_EQ(json["materials"].size(), kMaterials.size());
  EXPECT_EQ(json["materials"][0]["colour"], "#8a8178");
  const WorldFunction world(manifest);
  EXPECT_EQ(json["height_range_m"][0], world.height_range_m().x);
  ASSERT_EQ(json["parameters"].size(), manifest_parameters().size());
  for (const char* field : {"name", "unit", "value", "low", "high", "default", "meaning"}) {
    EXPECT_TRUE(json["parameters"][0].contains(field)) << field;
  }
}

}  // namespace
}  // namespace talus::protocol
