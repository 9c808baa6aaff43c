#include "inspect/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace prt::inspect {
namespace {

TEST(Histogram, CountsEveryValueOnce) {
  const std::vector<double> values = {0.0, 1e-12, 0.011, 0.012, 0.5, 0.5, 0.99};
  const Histogram histogram = make_histogram(values);
  EXPECT_EQ(histogram.zero_count, 1u);
  EXPECT_EQ(histogram.last_decade, 0);
  EXPECT_EQ(histogram.first_decade, -6);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::size_t{0}), 6u);
  EXPECT_EQ(histogram.counts.front(), 1u);
  EXPECT_EQ(histogram.counts[40], 2u);  // from 0.01
  EXPECT_EQ(histogram.counts[56], 2u);  // from 10^-0.4 = 0.398
  EXPECT_EQ(histogram.counts.back(), 1u);
  EXPECT_EQ(histogram.median, 0.012);
  EXPECT_EQ(histogram.percentile_99, 0.99);
}

TEST(Histogram, CsvListsAllBins) {
  const std::string csv = to_csv(make_histogram({0.0, 0.2, 3.0}));
  EXPECT_TRUE(csv.starts_with("lower,upper,count\n0,0,1\n0.1,0.125893,0\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2 + 20);
}

TEST(Histogram, PlotDrawsABarWhereTheValuesAre) {
  const image::Image plot_of_one =
      plot(make_histogram(std::vector<double>(5, 0.15)), "title", "axis");
  const image::Image plot_of_none = plot(make_histogram({}), "title", "axis");
  ASSERT_EQ(plot_of_one.width, plot_of_none.width);
  // Bars are blue: the bin of 0.15 is the second of ten.
  const auto is_bar = [](const image::Image& image, int x) {
    const float* p = image.at(x, 340);
    return p[2] > 2.0f * p[0];
  };
  const int left = 64, width = 640;
  EXPECT_TRUE(is_bar(plot_of_one, left + width * 15 / 100));
  EXPECT_FALSE(is_bar(plot_of_one, left + width * 25 / 100));
  EXPECT_FALSE(is_bar(plot_of_none, left + width * 15 / 100));
}

TEST(Histogram, AllZerosAndNothingAreDrawn) {
  for (const auto& values : {std::vector<double>{}, std::vector<double>{0.0, 0.0}}) {
    const Histogram histogram = make_histogram(values);
    EXPECT_EQ(histogram.zero_count, values.size());
    EXPECT_GT(plot(histogram, "title", "axis").width, 0);
  }
}

}  // namespace
}  // namespace prt::inspect
