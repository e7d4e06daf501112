// What a scanner does to everybody else's hits: ours against the longest unused, on the same requests.
#include <gtest/gtest.h>

#include "tests/support/cache_traces.hpp"

namespace talus::server {
namespace {

using talus::test::hot_hit_ratio;
using talus::test::interleaved;
using talus::test::LruCache;
using talus::test::OurCache;
using talus::test::Trace;

class Scan : public ::testing::Test {
 protected:
  static constexpr std::size_t kBytesMax = std::size_t{12} << 20;
  const std::vector<Trace> visits = talus::test::visits(8, 12);
};

TEST_F(Scan, CostsTheOthersAtMostFivePointsOfTheirHits) {
  const double calm = hot_hit_ratio<OurCache>(interleaved(visits, 0), kBytesMax);
  const double scanned = hot_hit_ratio<OurCache>(interleaved(visits, 40), kBytesMax);
  RecordProperty("calm", std::to_string(calm));
  RecordProperty("scanned", std::to_string(scanned));
  EXPECT_GT(calm, 0.9);
  EXPECT_GT(scanned, calm - 0.05);
  // The same requests through an order of last use: what this cache is for.
  const double lru_calm = hot_hit_ratio<LruCache>(interleaved(visits, 0), kBytesMax);
  const double lru_scanned = hot_hit_ratio<LruCache>(interleaved(visits, 40), kBytesMax);
  EXPECT_LT(lru_scanned, lru_calm - 0.10);
  EXPECT_GT(calm, lru_calm - 0.02) << "without a scanner it is as good";
}

}  // namespace
}  // namespace talus::server
