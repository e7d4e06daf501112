#include "server/schedule/gate.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace talus::server {
namespace {

TEST(Gate, LetsWorkInWhileItIsOpen) {
  Gate gate;
  const Gate::Pass pass = gate.enter();
  EXPECT_TRUE(pass);
  EXPECT_EQ(gate.inside(), 1U);
}

TEST(Gate, RefusesNewWorkOnceItIsClosed) {
  Gate gate;
  gate.close([] {});
  EXPECT_FALSE(gate.enter());
  EXPECT_TRUE(gate.is_closed());
}

TEST(Gate, SaysThatItIsEmptyWhenTheLastWorkHasEnded) {
  Gate gate;
  Gate::Pass first = gate.enter();
  Gate::Pass second = gate.enter();
  int told = 0;
  gate.close([&] { ++told; });
  first = Gate::Pass{};
  EXPECT_EQ(told, 0);
  second = Gate::Pass{};
  EXPECT_EQ(told, 1);
}

TEST(Gate, SaysSoAtOnceWhenNothingIsInside) {
  Gate gate;
  bool is_told = false;
  gate.close([&] { is_told = true; });
  EXPECT_TRUE(is_told);
}

TEST(Gate, CountsAMovedPassOnce) {
  Gate gate;
  {
    Gate::Pass first = gate.enter();
    const Gate::Pass second = std::move(first);
    EXPECT_EQ(gate.inside(), 1U);
  }
  EXPECT_EQ(gate.inside(), 0U);
}

}  // namespace
}  // namespace talus::server
