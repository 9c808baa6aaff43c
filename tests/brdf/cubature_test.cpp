#include "brdf/cubature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt::brdf {
namespace {

Integrand single(double (*f)(double, double)) {
  return [f](std::span<const Point> points, std::span<double> values) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = f(points[i].x, points[i].y);
  };
}

TEST(Cubature, IsExactForPolynomials) {
  const Box box{-1, 2, 1, 3};
  const auto result = integrate(
      {&box, 1}, single([](double x, double y) { return std::pow(x, 13) * std::pow(y, 12) + 1; }),
      {.tolerance = 1e-3});
  const double expected = (std::pow(2.0, 14) - 1) / 14 * ((std::pow(3.0, 13) - 1) / 13) + 6;
  EXPECT_NEAR(result.values[0], expected, 1e-13 * expected);
  EXPECT_LT(result.error, 1e-3);
  EXPECT_TRUE(result.converged);
}

// The rule of 15 points alone has degree 22.
TEST(Cubature, KronrodRuleHasItsDegree) {
  const Box interval{0, 1, 5, 5};
  const auto result =
      integrate({&interval, 1}, single([](double x, double) { return std::pow(2 * x - 1, 22); }),
                {.tolerance = 1, .max_box_count = 1});
  EXPECT_NEAR(result.values[0], 1.0 / 23, 1e-15);
}

TEST(Cubature, FindsPeaksAndKinksToTheTolerance) {
  const Box square[] = {{-1, 0.5, -1, 1}, {0.5, 1, -1, 1}};
  const auto peak = integrate(square, single([](double x, double y) {
                                return 1 / (1e-4 + x * x) / (1e-4 + (y - 0.3) * (y - 0.3));
                              }),
                              {.tolerance = 1e-2});
  const double across = 200 * std::atan(100.0), along = 100 * (std::atan(70.0) + std::atan(130.0));
  EXPECT_TRUE(peak.converged);
  EXPECT_NEAR(peak.values[0], across * along, 1e-2);
  const auto kink =
      integrate(square, single([](double x, double y) { return std::abs(x + y - 0.1); }),
                {.tolerance = 1e-6});
  EXPECT_TRUE(kink.converged);
  EXPECT_NEAR(kink.values[0], (std::pow(2.1, 3) + std::pow(1.9, 3) - 2 * std::pow(0.1, 3)) / 6,
              1e-6);
}

TEST(Cubature, SaysWhenItGivesUp) {
  const Box interval{0, 1, 0, 0};
  const auto result =
      integrate({&interval, 1}, single([](double x, double) { return std::sqrt(x); }),
                {.tolerance = 1e-15, .max_box_count = 3});
  EXPECT_FALSE(result.converged);
  EXPECT_GT(result.error, 1e-15);
  EXPECT_NEAR(result.values[0], 2.0 / 3, result.error);
}

TEST(Cubature, UncontrolledValuesDoNotRefine) {
  std::size_t point_count = 0;
  const Integrand both = [&](std::span<const Point> points, std::span<double> values) {
    point_count += points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      values[2 * i] = points[i].x;
      values[2 * i + 1] = std::sqrt(points[i].x);
    }
  };
  const Box interval{0, 1, 0, 0};
  const auto result =
      integrate({&interval, 1}, both, {.value_count = 2, .controlled_count = 1, .tolerance = 1e-9});
  EXPECT_EQ(point_count, 15u);
  EXPECT_NEAR(result.values[1], 2.0 / 3, 1e-3);
}

}  // namespace
}  // namespace prt::brdf
