#include "server/world/footprint_memo.hpp"

#include <gtest/gtest.h>

namespace talus::server {
namespace {

TEST(FootprintMemo, KnowsWhatItWasToldAndNothingElse) {
  FootprintMemo memo;
  EXPECT_FALSE(memo.load({0, 0, 0, 0}));
  memo.store({0, 2, -5, 7}, {10.0f, 90.0f});
  EXPECT_EQ(memo.load({0, 2, -5, 7}), (HeightInterval{10.0f, 90.0f}));
  EXPECT_FALSE(memo.load({1, 2, -5, 7})) << "another world";
  EXPECT_FALSE(memo.load({0, 3, -5, 7})) << "another LOD";
  EXPECT_FALSE(memo.load({0, 2, 7, -5})) << "another place";
}

TEST(FootprintMemo, MayForgetButNeverLies) {
  FootprintMemo memo;
  for (std::int32_t n = 0; n < 100'000; ++n) {
    memo.store({0, 0, n, -n}, {static_cast<float>(n), static_cast<float>(n) + 1});
  }
  int known = 0;
  for (std::int32_t n = 0; n < 100'000; ++n) {
    const auto heights = memo.load({0, 0, n, -n});
    if (!heights) continue;
    ++known;
    ASSERT_EQ(heights->low_m, static_cast<float>(n));
  }
  EXPECT_GT(known, 8'000);
  EXPECT_LE(known, 16'384);
}

}  // namespace
}  // namespace talus::server
