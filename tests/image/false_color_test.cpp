#include "image/false_color.h"

#include <gtest/gtest.h>

namespace prt::image {
namespace {

TEST(HeatColor, RunsFromBlueOverGreenToRedAndClamps) {
  EXPECT_EQ(heat_color(-1), Vec3(0, 0, 1));
  EXPECT_EQ(heat_color(0.25f), Vec3(0, 1, 1));
  EXPECT_EQ(heat_color(0.5f), Vec3(0, 1, 0));
  EXPECT_EQ(heat_color(0.75f), Vec3(1, 1, 0));
  EXPECT_EQ(heat_color(7), Vec3(1, 0, 0));
}

TEST(ClusterColor, NeighboursInNumberDiffer) {
  for (std::size_t i = 0; i < 300; ++i) {
    const Vec3 color = cluster_color(i);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(color[c], 0.0f);
      EXPECT_LE(color[c], 1.0f);
    }
    for (std::size_t j = i + 1; j < i + 8; ++j)
      EXPECT_GT((color - cluster_color(j)).length(), 0.15f) << i << " and " << j;
  }
}

}  // namespace
}  // namespace prt::image
