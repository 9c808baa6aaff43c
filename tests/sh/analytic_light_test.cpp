#include "sh/analytic_light.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/error.h"

namespace prt::sh {
namespace {

TEST(AnalyticLight, NumbersMakeTheLightTheyDescribe) {
  const float disk[] = {0, 0, 2, 90, 1, 2, 3};
  const Light light = analytic_light(AnalyticKind::disk, 4, disk);
  const Light expected = disk_light(4, {0, 0, 1}, std::numbers::pi_v<float> / 2, {1, 2, 3});
  EXPECT_EQ(light.coefficients, expected.coefficients);
  EXPECT_EQ(light.source, "disk 0,0,2,90,1,2,3");
  const float directional[] = {0, 3, 0, 1, 2, 3};
  EXPECT_EQ(analytic_light(AnalyticKind::directional, 4, directional).coefficients,
            directional_light(4, {0, 1, 0}, {1, 2, 3}).coefficients);
  const float long_one[] = {0, 1e30f, 0, 1, 2, 3}, short_one[] = {0, 1e-40f, 0, 1, 2, 3};
  EXPECT_EQ(analytic_light(AnalyticKind::directional, 4, long_one).coefficients,
            directional_light(4, {0, 1, 0}, {1, 2, 3}).coefficients);
  EXPECT_EQ(analytic_light(AnalyticKind::directional, 4, short_one).coefficients,
            directional_light(4, {0, 1, 0}, {1, 2, 3}).coefficients);
  const float constant[] = {1, 2, 3};
  EXPECT_EQ(analytic_light(AnalyticKind::constant, 4, constant).coefficients,
            constant_light(4, {1, 2, 3}).coefficients);
}

TEST(AnalyticLight, RejectsNumbersThatMakeNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::pair<AnalyticKind, std::vector<float>> bad[] = {
      {AnalyticKind::constant, {1, 2}},
      {AnalyticKind::constant, {1, 2, nan}},
      {AnalyticKind::directional, {0, 0, 0, 1, 1, 1}},
      {AnalyticKind::disk, {0, 1, 0, 0, 1, 1, 1}},
      {AnalyticKind::disk, {0, 1, 0, 181, 1, 1, 1}}};
  for (const auto& [kind, numbers] : bad) {
    try {
      analytic_light(kind, 3, numbers);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

}  // namespace
}  // namespace prt::sh
