// Runs the committed corpus of one target, and reproducible mutations of it, through the function that is fuzzed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_one.hpp"

/// The folder of the target's corpus; the build writes it.
extern const char* const fuzz_corpus;

namespace {

std::vector<std::string> corpus() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(fuzz_corpus)) paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  std::vector<std::string> out;
  for (const std::string& path : paths) {
    std::ifstream file(path, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return out;
}

void run(const std::string& bytes) {
  // Exactly as long as the input, so that a sanitizer sees one byte too many.
  const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());
  EXPECT_EQ(fuzz_one(exact.data(), exact.size()), 0);
}

TEST(Replay, SurvivesTheCorpus) {
  const std::vector<std::string> inputs = corpus();
  ASSERT_FALSE(inputs.empty());
  run("");
  for (const std::string& input : inputs) run(input);
}

TEST(Replay, SurvivesMutationsOfTheCorpus) {
  constexpr std::uint64_t kSeed = 20261122;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  const std::vector<std::string> inputs = corpus();
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = inputs[random() % inputs.size()];
    const std::string& other = inputs[random() % inputs.size()];
    for (std::uint64_t i = 1 + random() % 6; i > 0 && !bytes.empty(); --i) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 5) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes[at] ^= static_cast<char>(1U << random() % 8);
          break;
        case 2:
          bytes.resize(at);
          break;
        case 3:
          bytes.insert(at, other.substr(0, random() % 32));
          break;
        default:
          bytes.erase(at, 1 + random() % 8);
          break;
      }
    }
    run(bytes);
  }
}

}  // namespace
