#include "client_sample/cli/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/default_world.hpp"

namespace talus::cli {
namespace {

using test::world;

/// The made-up squares stand anywhere in the world: what hangs over there is nobody's question.
constexpr int kProbes = 10;

SurveyGrid grid_of(const std::function<double(double, double)>& height, int edge = 256) {
  SurveyGrid out;
  out.edge = edge;
  out.spacing_m = 16;
  for (int k = 0; k < edge; ++k) {
    for (int i = 0; i < edge; ++i) out.height_m.push_back(static_cast<float>(height(i, k)));
  }
  out.ridge.assign(out.height_m.size(), 0.0F);
  return out;
}

TEST(Survey, MeasuresAStraightSlopingShore) {
  const SurveyGrid grid = grid_of([](double i, double) { return (i - 127.5) * 8; });
  const SurveyFigures f = survey_figures(world(), grid, kProbes);
  EXPECT_NEAR(f.land_share, 0.5, 0.01);
  for (const double slope : f.slope_percentiles) EXPECT_NEAR(slope, 0.5, 1e-4);
  EXPECT_NEAR(f.coast_dimension, 1, 0.08);
  EXPECT_NEAR(f.coast_km, 256 * 0.016, 0.1);
  EXPECT_EQ(f.drainage_km_per_km2, 0);
  double sum = 0;
  for (const double share : f.bin_shares) sum += share;
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(Survey, GivesARaggedShoreAHigherDimension) {
  const auto ragged = [](double i, double k) {
    double h = i - 128;
    for (double n = 1; n < 64; n *= 2) h += 70 / n * std::sin(k * n / 20 + n) * std::sin(i * n / 31 + 2 * n);
    return h;
  };
  EXPECT_GT(survey_figures(world(), grid_of(ragged), kProbes).coast_dimension, 1.12);
}

TEST(Survey, FindsThePeakTheCanyonTheLakeAndTheIslands) {
  const auto shape = [](double i, double k) {
    const auto bump = [&](double x, double z, double wide) {
      return std::exp(-(std::pow(i - x, 2) + std::pow(k - z, 2)) / (wide * wide));
    };
    double h = 100 + 1400 * bump(60, 60, 20) - 300 * bump(60, 190, 8);  // a peak, a lake
    if (i > 62 && i < 149 && k > 90 && k < 130) h += 500 - 580 * std::exp(-std::pow((i - 110) / 5, 2));  // a canyon
    if (i > 150) h = -200 + 400 * (bump(180, 60, 5) + bump(200, 75, 5) + bump(215, 55, 5) + bump(190, 90, 5));
    return h;
  };
  const auto places = survey_places(world(), grid_of(shape));
  const auto find = [&](std::string_view kind) { return std::ranges::find(places, kind, &SurveyPlace::kind); };
  ASSERT_NE(find("peak"), places.end());
  EXPECT_NEAR(find("peak")->place_m.x, 60 * 16, 33);
  EXPECT_NEAR(find("peak")->place_m.z, 60 * 16, 33);
  ASSERT_NE(find("canyon"), places.end());
  EXPECT_LT(std::abs(find("canyon")->place_m.x - 110 * 16), 50);
  ASSERT_NE(find("inland water"), places.end());
  EXPECT_NEAR(find("inland water")->place_m.z, 190 * 16, 200);
  ASSERT_NE(find("island chain"), places.end());
  EXPECT_NE(find("island chain")->why.find("4 islands"), std::string::npos) << find("island chain")->why;
  EXPECT_NE(find("trench"), places.end());
}

TEST(Survey, OfOneSquareIsTheSameTwice) {
  const MapArea area{{0, 0}, 2'000};
  const SurveyGrid a = survey_grid(world(), area);
  const SurveyGrid b = survey_grid(world(), area);
  EXPECT_EQ(a.height_m, b.height_m);
  const auto first = survey_places(world(), a);
  const auto second = survey_places(world(), b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].why, second[i].why);
}

}  // namespace
}  // namespace talus::cli
