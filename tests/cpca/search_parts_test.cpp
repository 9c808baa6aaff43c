// What the search is made of: the model of errors, the survey of a sample, starts from clusters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/error.h"
#include "cpca/encoder.h"
#include "cpca/one_cluster.h"
#include "cpca/search_resize.h"
#include "cpca/search_survey.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

/// Errors that are exactly what the model supposes.
double power_law(int clusters, int components) {
  return std::exp(-0.4 * components) * std::pow(clusters, -0.3 - 0.1 * components);
}

ErrorModel make_model() {
  ErrorModel model;
  for (const int clusters : {64, 4, 16}) {
    Column column{clusters, {}};
    for (int i = 0; i <= (clusters == 64 ? 2 : 5); ++i) {
      column.errors.push_back(power_law(clusters, i));
    }
    model.add(column);
  }
  return model;
}

// Points whose weights are made together are all zero; the mean is not.
TEST(OneCluster, ErrorsAreThoseOfOneEncodingHoweverPointsAreOrdered) {
  std::vector<float> signal = random_values(10000 * 4, 3);
  std::fill_n(signal.begin(), 9000 * 4, 0.0f);
  const auto weights = random_values(10000, 4);
  std::vector<float> point_weights;
  for (const float weight : weights) point_weights.push_back(weight + 1.0f);
  const Encoded encoded = encode_static(
      signal, 4, {.cluster_count = 1, .component_count = 3, .point_weights = point_weights});
  for (const Norm norm : {Norm::rmse, Norm::maximum}) {
    const auto expected = relative_errors(encoded.encoding, signal, norm, point_weights);
    const OneCluster one = measure_one_cluster(signal, 4, 3, norm, point_weights);
    ASSERT_EQ(one.errors.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(one.errors[i], expected[i], 1e-6) << i;
    EXPECT_GT(one.errors[0], 0.5);
    EXPECT_GT(one.flops, 0.0);
    EXPECT_LE(one.flops, encoded.flops);
  }
}

TEST(ErrorModel, FollowsPowerLawsBetweenAndBeyondItsColumns) {
  const ErrorModel model = make_model();
  EXPECT_EQ(model.most_components(), 5);
  for (const int clusters : {1, 3, 4, 9, 40, 64, 300}) {
    for (int i = 0; i <= 2; ++i) {
      const double expected = power_law(clusters, i);
      EXPECT_NEAR(model.error({clusters, i}), expected, 1e-9 * expected);
    }
  }
  EXPECT_NEAR(model.error({8, 5}), power_law(8, 5), 1e-9);
  // Beyond the end of the last column like the one before, a little too great.
  EXPECT_NEAR(model.error({64, 3}), power_law(64, 3), 0.2 * power_law(64, 3));
  EXPECT_LT(model.error({64, 3}), model.error({64, 2}));
}

TEST(ErrorModel, IsRightWhereItWasCorrected) {
  ErrorModel model = make_model();
  model.correct(Column{10, {0.5, 0.2, 0.1}});
  EXPECT_NEAR(model.error({10, 0}), 0.5, 1e-12);
  EXPECT_NEAR(model.error({10, 1}), 0.2, 1e-12);
  EXPECT_NEAR(model.error({20, 1}), 0.2 * std::pow(2.0, -0.4), 1e-12);
  EXPECT_NEAR(model.error({10, 3}), 0.1 * power_law(10, 3) / power_law(10, 2), 1e-9);
  model.correct({10, 1}, 0.3);
  EXPECT_NEAR(model.error({10, 1}), 0.3, 1e-12);
  EXPECT_NEAR(model.error({10, 0}), 0.75, 1e-12);
}

TEST(Choose, IsTheBestOfAll) {
  const ErrorModel model = make_model();
  const Size size{5000, 12};
  for (const double max_error : {0.5, 0.1, 0.03, 0.01}) {
    const Bound bound{.max_error = max_error, .max_bytes = {}};
    const std::size_t found = bound.cost.bytes(size, choose(model, bound, size, 2500));
    std::size_t least = ~std::size_t{0};
    for (int i = 0; i <= 7; ++i) {
      for (int clusters = 1; clusters <= 2500; ++clusters) {
        if (model.error({clusters, i}) > max_error) continue;
        least = std::min(least, bound.cost.bytes(size, {clusters, i}));
      }
    }
    EXPECT_EQ(found, least);
  }
  const Bound bound{.max_error = {}, .max_bytes = 60000};
  const Choice chosen = choose(model, bound, size, 2500);
  EXPECT_LE(bound.cost.bytes(size, chosen), 60000u);
  for (int i = 0; i <= 7; ++i) {
    for (int clusters = 1; clusters <= 2500; ++clusters) {
      if (bound.cost.bytes(size, {clusters, i}) > 60000) continue;
      EXPECT_GE(model.error({clusters, i}), model.error(chosen));
    }
  }
  EXPECT_THROW(choose(model, {.max_error = {}, .max_bytes = 10000}, size, 2500), Error);
}

// Headers alone may be more than twice a small signal.
TEST(Bound, WithoutBytesLeavesRoomForOneClusterWithAllVectors) {
  Bound bound{.max_error = 0.1, .max_bytes = {}, .cost = {.bytes_of_headers = 1500}};
  for (const std::size_t count : {1u, 5u, 12u, 64u, 5000u}) {
    const Size size{count, 12};
    EXPECT_EQ(bound.cost.whole(size), (Choice{1, 12}));
    EXPECT_GE(bound.most_bytes(size), bound.cost.bytes(size, {1, 12}));
    EXPECT_GE(bound.most_bytes(size), 1500 + 2 * sizeof(float) * 12 * count);
    EXPECT_EQ(choose_most(bound, size, 1, 12), (Choice{1, 12}));
  }
  bound.cost.max_component_count = 3;
  EXPECT_EQ(bound.cost.whole({5, 12}), (Choice{1, 3}));
  bound.max_bytes = 100;
  EXPECT_EQ(bound.most_bytes({5, 12}), 100u);
}

// Without the correction for degrees of freedom the sample's clusters look 10 to 30% too good.
TEST(Survey, TellsTheErrorsOfAllPointsFromAQuarter) {
  constexpr int kDimension = 24;
  constexpr std::size_t kPointCount = 16384;
  const auto signal = make_signal(kPointCount, kDimension, 8);
  for (const Method method : {Method::fixed, Method::iterative}) {
    const Options options{.iterations = 4};
    const Survey survey =
        make_survey({.max_error = 0.02, .max_bytes = {}}, method, signal, kDimension, options);
    EXPECT_EQ(survey.sampled_count, kPointCount / 4);
    Options full = options;
    full.cluster_count = 85;  // of its first column
    full.component_count = 2;
    const double error =
        relative_error(encode(method, signal, kDimension, full).encoding, signal, Norm::rmse);
    EXPECT_NEAR(survey.model.error({full.cluster_count, 2}), error, 0.06 * error)
        << full.cluster_count;
  }
}

TEST(ResizeClusters, SplitsTheWorstAndDissolvesTheBest) {
  const Encoding encoding{.point_count = 6,
                          .dimension = 1,
                          .cluster_count = 3,
                          .component_count = 1,
                          .means = {0, 10, 12},
                          .bases = {1, 1, 1},
                          .cluster_of_point = {0, 0, 1, 1, 2, 2},
                          .weights = {-1, 1, -1, 1, -1, 1}};
  const std::vector<double> errors{1, 2, 5, 5, 0, 1};
  using Labels = std::vector<std::uint32_t>;
  EXPECT_EQ(resize_clusters(encoding, errors, 3), Labels({0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(resize_clusters(encoding, errors, 4), Labels({0, 0, 1, 3, 2, 2}));
  EXPECT_EQ(resize_clusters(encoding, errors, 6), Labels({0, 4, 1, 3, 2, 5}));
  EXPECT_EQ(resize_clusters(encoding, errors, 2), Labels({1, 1, 0, 0, 0, 0}));
}

TEST(Start, FromOtherClustersIsAsGoodAsFromSeeds) {
  constexpr int kDimension = 128;
  const auto signal = make_signal(3000, kDimension, 8);
  for (const Method method : {Method::fixed, Method::iterative, Method::adaptive}) {
    Options options{.cluster_count = 40, .component_count = 3};
    const Encoding first = encode(method, signal, kDimension, options).encoding;
    const auto errors = point_errors(first, signal);
    for (const int count : {32, 50}) {
      options.cluster_count = count;
      options.start = {};
      const double expected =
          relative_error(encode(method, signal, kDimension, options).encoding, signal, Norm::rmse);
      const auto labels = resize_clusters(first, errors, count);
      options.start = {labels, std::accumulate(errors.begin(), errors.end(), 0.0)};
      const Encoded warm = encode(method, signal, kDimension, options);
      EXPECT_LT(relative_error(warm.encoding, signal, Norm::rmse), 1.02 * expected);
      EXPECT_EQ(warm.levels.size(), method == Method::fixed       ? 0u
                                    : method == Method::iterative ? 1u
                                                                  : 2u);
    }
  }
}

}  // namespace
}  // namespace prt::cpca
