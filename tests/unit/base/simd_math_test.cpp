#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/base/simd_math_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Fills one row of results per function for inputs in [0, 1).
void evaluate(const float* unit, std::size_t count, float* cosine, float* sine, float* exponential, float* power) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto u = hn::LoadU(d, unit + i);
    hn::Vec<decltype(d)> c;
    hn::Vec<decltype(d)> s;
    cos_sin_cycles(d, hn::Mul(hn::Sub(u, hn::Set(d, 0.5f)), hn::Set(d, 40.0f)), c, s);
    hn::StoreU(c, d, cosine + i);
    hn::StoreU(s, d, sine + i);
    hn::StoreU(exp_to_minus_4_5(d, hn::Mul(u, hn::Set(d, -4.5f))), d, exponential + i);
    hn::StoreU(pow_unit(d, u, hn::Set(d, 1.8f)), d, power + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
namespace {
HWY_EXPORT(evaluate);

struct Results {
  std::vector<float> cosine, sine, exponential, power;
  explicit Results(const std::vector<float>& unit)
      : cosine(unit.size()), sine(unit.size()), exponential(unit.size()), power(unit.size()) {
    HWY_DYNAMIC_DISPATCH(evaluate)
    (unit.data(), unit.size(), cosine.data(), sine.data(), exponential.data(), power.data());
  }
};

std::vector<float> unit_samples() {
  test::Random random(1);
  std::vector<float> out(1 << 16);
  for (float& v : out) v = static_cast<float>(random.unit());
  out[0] = 0.0f;
  out[1] = 0.5f;
  return out;
}

TEST(SimdMath, IsAsCloseToTheExactFunctionsAsItsHeaderSays) {
  const auto unit = unit_samples();
  const Results r(unit);
  double trigonometric = 0;
  double exponential = 0;
  double power = 0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const double u = static_cast<double>(unit[i]);
    // The kernel's own argument, rounded as it rounds it: what is tested is the function, not its input.
    const double cycles = static_cast<double>((unit[i] - 0.5f) * 40.0f);
    const double x = static_cast<double>(unit[i] * -4.5f);
    trigonometric =
        std::max(trigonometric, std::abs(static_cast<double>(r.cosine[i]) - std::cos(2 * std::numbers::pi * cycles)));
    trigonometric =
        std::max(trigonometric, std::abs(static_cast<double>(r.sine[i]) - std::sin(2 * std::numbers::pi * cycles)));
    exponential = std::max(exponential, std::abs(static_cast<double>(r.exponential[i]) / std::exp(x) - 1));
    if (u > 0x1p-15) power = std::max(power, std::abs(static_cast<double>(r.power[i]) / std::pow(u, 1.8) - 1));
  }
  EXPECT_LT(trigonometric, 3e-6);
  EXPECT_LT(exponential, 2e-6);
  EXPECT_LT(power, 4e-5);
  EXPECT_EQ(r.power[0], 0.0f);
}

TEST(SimdMath, GivesTheSameBitsOnEveryTarget) {
  const auto unit = unit_samples();
  const Results best(unit);
  const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
  };
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Results r(unit);
    EXPECT_TRUE(same(r.cosine, best.cosine)) << target;
    EXPECT_TRUE(same(r.sine, best.sine)) << target;
    EXPECT_TRUE(same(r.exponential, best.exponential)) << target;
    EXPECT_TRUE(same(r.power, best.power)) << target;
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
#endif  // HWY_ONCE
