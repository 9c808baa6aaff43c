#include "cpca/principal_axes.h"

#include <gtest/gtest.h>

#include "cpca/signals.h"
#include "cpca/working_space.h"

namespace prt::cpca {
namespace {

double at(const PrincipalAxes& axes, std::size_t point, std::size_t axis) {
  return double{static_cast<float>(axes.rows[point * axes.stride + axis])} *
         double{axes.scales[axis]};
}

TEST(PrincipalAxes, SquaresOfRowsAndTailsAddUpToTheVariance) {
  constexpr std::size_t n = 64, point_count = 3000, count = 20;
  const auto signal = make_signal(point_count, n, 2);
  const PrincipalAxes axes = find_principal_axes(signal, n, count, {});
  ASSERT_EQ(axes.count(), count);
  std::vector<double> squares(count + 1);
  for (std::size_t p = 0; p < point_count; ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      const double y = signal[p * n + i] - axes.mean[i];
      squares[0] += y * y;
    }
    for (std::size_t i = 0; i < count; ++i) {
      squares[1 + i] += at(axes, p, i) * at(axes, p, i);
    }
  }
  EXPECT_NEAR(axes.tails[0], squares[0], 1e-6 * squares[0]);
  for (std::size_t i = 0; i < count; ++i) {
    squares[0] -= squares[1 + i];
    EXPECT_NEAR(axes.tails[1 + i], squares[0], 1e-5 * axes.tails[0]);
  }
  EXPECT_LT(axes.tails[12], 0.01 * axes.tails[0]);  // two groups of six directions
}

TEST(PrincipalAxes, ConvertOtherPointsLikeTheSignals) {
  constexpr std::size_t n = 64;
  const auto signal = make_signal(500, n, 2);
  const PrincipalAxes axes = find_principal_axes(signal, n, 16, {});
  const auto rows = to_axes(axes, std::span(signal).first(3 * n));
  ASSERT_EQ(rows.size(), 3 * axes.stride);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(rows[i], at(axes, i / axes.stride, i % axes.stride),
                0.51 * double{axes.scales[i % axes.stride]});
  }
}

TEST(WorkingSpace, TakesTheSignalItselfWhereAxesWouldLoseIt) {
  const auto noise = random_values(1000 * 128, 1);
  WorkingSpace space(noise, 128, {});
  space.fit_to(1000.0);
  EXPECT_EQ(space.rows().values, noise.data());
  EXPECT_EQ(space.dimension(), 128u);
  EXPECT_EQ(space.tail(), 0.0);
  const auto signal = make_signal(1000, 128, 2);
  WorkingSpace flat(signal, 128, {});
  EXPECT_FALSE(flat.fit_to(1000.0));
  EXPECT_LT(flat.dimension(), 64u);
  EXPECT_LE(flat.tail(), 50.0);
  EXPECT_FALSE(WorkingSpace(signal, 128, {}, false).has_axes());
}

TEST(WorkingSpace, TakesTheSignalItselfForErrorsOfRounding) {
  const auto signal = make_smooth_signal(30, 128, 3.0f);
  WorkingSpace space(signal, 128, {});
  const double variance = find_principal_axes(signal, 128, 16, {}).tails[0];
  EXPECT_FALSE(space.fit_to(1e-4 * variance));
  EXPECT_TRUE(space.has_axes());
  EXPECT_TRUE(space.fit_to(5e-6 * variance));
  EXPECT_FALSE(space.has_axes());
}

}  // namespace
}  // namespace prt::cpca
