#include "inspect/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/vec.h"

namespace prt::inspect {
namespace {

image::Image filled(int width, int height, const Vec4& color) {
  image::Image image(width, height, 4);
  for (int i = 0; i < width * height; ++i) {
    for (int c = 0; c < 4; ++c) image.pixels[static_cast<std::size_t>(4 * i + c)] = color[c];
  }
  return image;
}

TEST(Compare, MeasuresCoveredPixelsOnly) {
  ComparisonInput input{filled(4, 2, Vec4(1.0f)), filled(4, 2, Vec4(1.0f)), {}, {}};
  input.image.at(1, 1)[0] = 1.5f;    // counts
  input.image.at(2, 0)[1] = 100.0f;  // does not: not covered here
  input.image.at(2, 0)[3] = 0.5f;
  input.reference.at(3, 0)[3] = 0.0f;  // nor this, not covered there
  const Comparison result = compare(input);
  EXPECT_EQ(result.json["pixel_count"], 6);
  EXPECT_DOUBLE_EQ(result.json["relative_rmse"], 0.5 / std::sqrt(18.0));
  EXPECT_DOUBLE_EQ(result.json["rmse"], 0.5 / std::sqrt(18.0));
  EXPECT_DOUBLE_EQ(result.json["bias"], 0.5 / 18.0);
  EXPECT_DOUBLE_EQ(result.json["relative_bias"], 0.5 / 18.0);
  EXPECT_DOUBLE_EQ(result.json["difference"]["max"], 0.5);
  EXPECT_EQ(result.json["worst_pixel"], Json({1, 1}));
  EXPECT_EQ(*result.difference.at(2, 0), -1.0f);
  EXPECT_EQ(*result.difference.at(1, 1), 0.5f);
}

TEST(Compare, MaskLeavesPixelsOut) {
  ComparisonInput input{filled(2, 1, Vec4(1.0f)), filled(2, 1, Vec4(1.0f)), {}, {}};
  input.image.at(1, 0)[0] = 9.0f;
  input.mask = image::Image(2, 1, 1);
  *input.mask->at(0, 0) = 1.0f;
  EXPECT_EQ(compare(input).json["pixel_count"], 1);
  EXPECT_EQ(compare(input).json["relative_rmse"], 0.0);
}

TEST(Compare, TellsNoiseFromTheRest) {
  ComparisonInput input{
      filled(8, 8, Vec4(1.3f, 1.3f, 1.3f, 1.0f)), filled(8, 8, Vec4(1.0f)), {}, {}};
  input.noise = image::Image(8, 8, 3);
  std::fill(input.noise->pixels.begin(), input.noise->pixels.end(), 0.18f);
  const Json json = compare(input).json;
  EXPECT_NEAR(json["relative_rmse"].get<double>(), 0.3, 1e-6);
  EXPECT_NEAR(json["noise_relative_rmse"].get<double>(), 0.18, 1e-6);
  EXPECT_NEAR(json["noise_share"].get<double>(), 0.36, 1e-5);
  EXPECT_NEAR(json["relative_rmse_without_noise"].get<double>(), 0.24, 1e-6);
}

TEST(Compare, RejectsOtherSizesAndNothingToCompare) {
  EXPECT_THROW(compare({filled(2, 2, Vec4(1.0f)), filled(2, 3, Vec4(1.0f)), {}, {}}), Error);
  EXPECT_THROW(compare({filled(2, 2, Vec4(0.0f)), filled(2, 2, Vec4(1.0f)), {}, {}}), Error);
}

TEST(Compare, HeatmapRunsFromBlueToRed) {
  ComparisonInput input{filled(300, 1, Vec4(1.0f)), filled(300, 1, Vec4(1.0f)), {}, {}};
  input.image.at(1, 0)[0] = 3.0f;
  input.image.at(2, 0)[3] = 0.0f;
  const image::Image map = heatmap(compare(input), 2.0);
  EXPECT_EQ(map.at(0, 0)[2], 1.0f);
  EXPECT_EQ(map.at(0, 0)[0], 0.0f);
  EXPECT_EQ(map.at(1, 0)[0], 1.0f);
  EXPECT_EQ(map.at(1, 0)[2], 0.0f);
  EXPECT_EQ(map.at(2, 0)[0], map.at(2, 0)[2]);
}

TEST(Compare, EqualImagesAreBlueWhateverTheScale) {
  const ComparisonInput input{filled(2, 1, Vec4(1.0f)), filled(2, 1, Vec4(1.0f)), {}, {}};
  const image::Image map = heatmap(compare(input), 0.0);
  for (int x = 0; x < 2; ++x) {
    EXPECT_EQ(map.at(x, 0)[0], 0.0f);
    EXPECT_EQ(map.at(x, 0)[2], 1.0f);
  }
}

}  // namespace
}  // namespace prt::inspect
