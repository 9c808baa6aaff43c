// Static CPCA against [Sloan03] §4.1 and against decompositions of whole matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/cluster_pca.h"
#include "cpca/clusters.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/signals.h"
#include "linalg/decompose.h"

namespace prt::cpca {
namespace {

Figures figures_of(const Encoded& encoded, const std::vector<float>& signal) {
  return summarize(point_errors(encoded.encoding, signal), signal);
}

double dot(std::span<const float> a, std::span<const float> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}

void expect_orthonormal_or_zero(const Encoding& encoding) {
  for (int k = 0; k < encoding.cluster_count; ++k) {
    for (int i = 0; i < encoding.component_count; ++i) {
      const double length = dot(encoding.basis(k, i), encoding.basis(k, i));
      EXPECT_NEAR(length, length == 0.0 ? 0.0 : 1.0, 1e-6);
      for (int j = 0; j < i; ++j) {
        EXPECT_NEAR(dot(encoding.basis(k, i), encoding.basis(k, j)), 0.0, 1e-6);
      }
    }
  }
}

// [Sloan03] §4.2: ‖x - x̃‖² = ‖x - x_0‖² - Σ ((x - x_0)·x_i)², point by point.
TEST(StaticEncoder, ErrorIsDistanceToTheMeanLessWhatTheWeightsHold) {
  constexpr std::size_t n = 40;
  const auto signal = make_signal(800, n);
  const Encoded encoded = encode_static(signal, n, {.cluster_count = 6, .component_count = 5});
  const Encoding& encoding = encoded.encoding;
  expect_orthonormal_or_zero(encoding);
  const auto errors = point_errors(encoding, signal);
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const auto cluster = static_cast<int>(encoding.cluster_of_point[p]);
    std::vector<float> offset(n);
    for (std::size_t i = 0; i < n; ++i) offset[i] = signal[p * n + i] - encoding.mean(cluster)[i];
    double expected = dot(offset, offset);
    for (int i = 0; i < 5; ++i) {
      const double weight = dot(offset, encoding.basis(cluster, i));
      EXPECT_NEAR(encoding.weights[p * 5 + static_cast<std::size_t>(i)], weight, 1e-5);
      expected -= weight * weight;
    }
    EXPECT_NEAR(errors[p], expected, 1e-5);
  }
}

// §4.1: the error that n' components leave is the sum of the other squared singular values.
TEST(StaticEncoder, ErrorIsTheSumOfTheSingularValuesLeftOut) {
  constexpr std::size_t n = 30, point_count = 400;
  const auto signal = make_signal(point_count, n, 1);
  for (int components : {0, 1, 3, 8}) {
    const Encoded encoded =
        encode_static(signal, n, {.cluster_count = 1, .component_count = components});
    std::vector<double> centred(signal.begin(), signal.end());
    for (std::size_t i = 0; i < centred.size(); ++i) centred[i] -= encoded.encoding.means[i % n];
    const auto values = linalg::svd({centred.data(), point_count, n}).values;
    double expected = 0.0;
    for (auto i = static_cast<std::size_t>(components); i < values.size(); ++i) {
      expected += values[i] * values[i];
    }
    EXPECT_NEAR(figures_of(encoded, signal).squared_error, expected, 1e-4 * expected);
  }
}

TEST(StaticEncoder, FullRankIsExact) {
  constexpr std::size_t n = 12;
  const auto signal = make_signal(300, n);
  for (int clusters : {1, 5}) {
    const Encoded encoded =
        encode_static(signal, n, {.cluster_count = clusters, .component_count = n});
    EXPECT_LT(figures_of(encoded, signal).relative_rmse(), 1e-6);
  }
  // 8 points in 40 dimensions: the outer form, and components beyond the rank.
  const auto few = make_signal(8, 40);
  const Encoded encoded = encode_static(few, 40, {.cluster_count = 1, .component_count = 20});
  EXPECT_LT(figures_of(encoded, few).relative_rmse(), 1e-6);
  expect_orthonormal_or_zero(encoded.encoding);
  for (int i = 7; i < 20; ++i) {  // eight points about their mean span seven directions
    EXPECT_EQ(dot(encoded.encoding.basis(0, i), encoded.encoding.basis(0, i)), 0.0);
  }
}

TEST(ClusterPca, BothNormalFormsGiveTheSameVectors) {
  constexpr std::size_t n = 32, count = 5;
  for (std::size_t point_count : {20u, 32u, 60u}) {
    const auto signal = make_signal(point_count, n, 1);
    const auto sorted = sort_by_cluster(std::vector<std::uint32_t>(point_count), 1);
    std::vector<float> mean(n);
    for (std::size_t i = 0; i < signal.size(); ++i) {
      mean[i % n] += signal[i] / static_cast<float>(point_count);
    }
    std::vector<float> inner(count * n), outer(count * n);
    find_components(signal, sorted.of(0), {mean, inner}, {}, NormalForm::inner);
    find_components(signal, sorted.of(0), {mean, outer}, {}, NormalForm::outer);
    for (std::size_t i = 0; i < inner.size(); ++i) EXPECT_NEAR(inner[i], outer[i], 1e-5);
    EXPECT_GT(dot(inner, inner), count - 0.001);
  }
}

TEST(ClusterPca, LargeClustersAndSmallOnesAgree) {
  constexpr std::size_t n = 80, count = 3;  // 10000 points take the threaded way
  const auto half = make_signal(5000, n, 1);
  auto twice = half;
  twice.insert(twice.end(), half.begin(), half.end());
  const std::vector<float> mean(half.begin(), half.begin() + n);
  std::vector<float> small(count * n), large(count * n);
  find_components(half, sort_by_cluster(std::vector<std::uint32_t>(5000), 1).of(0), {mean, small});
  find_components(twice, sort_by_cluster(std::vector<std::uint32_t>(10000), 1).of(0),
                  {mean, large});
  for (std::size_t i = 0; i < small.size(); ++i) EXPECT_NEAR(small[i], large[i], 1e-5);
}

TEST(ClusterPca, LargestCoefficientIsPositive) {
  constexpr std::size_t n = 20;
  const auto signal = make_signal(100, n);
  const Encoded encoded = encode_static(signal, n, {.cluster_count = 3, .component_count = 4});
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 4; ++i) {
      const auto basis = encoded.encoding.basis(k, i);
      const float largest = *std::max_element(
          basis.begin(), basis.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
      EXPECT_GT(largest, 0.0f);
    }
  }
}

TEST(StaticEncoder, SameBytesForAnyThreadCountAndTwice) {
  constexpr std::size_t n = 100;
  const auto signal = make_signal(12000, n, 5);
  for (int clusters : {1, 40}) {
    const auto encode = [&](int threads) {
      set_thread_count(threads);
      return encode_static(signal, n, {.cluster_count = clusters, .component_count = 6}).encoding;
    };
    const Encoding one = encode(1);
    for (int threads : {2, 4, 2}) {
      const Encoding other = encode(threads);
      EXPECT_EQ(one.means, other.means);
      EXPECT_EQ(one.bases, other.bases);
      EXPECT_EQ(one.cluster_of_point, other.cluster_of_point);
      EXPECT_EQ(one.weights, other.weights);
    }
    set_thread_count(0);
  }
}

TEST(StaticEncoder, MoreComponentsAndMoreClustersLeaveLessError) {
  const auto signal = make_signal(3000, 25, 8);
  const auto error = [&](int clusters, int components) {
    return figures_of(encode_static(signal, 25,
                                    {.cluster_count = clusters, .component_count = components}),
                      signal)
        .squared_error;
  };
  EXPECT_LT(error(16, 4), 0.8 * error(16, 0));
  EXPECT_LT(error(64, 4), error(16, 4));
  EXPECT_LT(error(16, 8), error(16, 4));
}

TEST(StaticEncoder, DegenerateSignalsAreExact) {
  for (const DegenerateCase& test : degenerate_cases()) {
    const Encoded encoded = encode_static(test.signal, 9, test.options);
    EXPECT_LT(figures_of(encoded, test.signal).relative_rmse(), 1e-6) << test.name;
    expect_orthonormal_or_zero(encoded.encoding);
    for (float value : encoded.encoding.weights) EXPECT_TRUE(std::isfinite(value)) << test.name;
    for (float value : encoded.encoding.means) EXPECT_TRUE(std::isfinite(value)) << test.name;
  }
}

TEST(StaticEncoder, OnePoint) {
  const std::vector<float> point{1, 2, 3};
  const Encoded encoded = encode_static(point, 3, {.cluster_count = 1, .component_count = 3});
  EXPECT_EQ(encoded.encoding.means, point);
  EXPECT_EQ(encoded.encoding.weights, std::vector<float>(3));
}

std::string message_of(std::span<const float> signal, int dimension, const Options& options,
                       ErrorKind kind) {
  try {
    encode_static(signal, dimension, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(StaticEncoder, RefusesOptionsThatDoNotFit) {
  const auto signal = random_values(40, 1);  // 10 × 4
  const auto usage = ErrorKind::usage;
  EXPECT_EQ(message_of(signal, 4, {.cluster_count = 0}, usage),
            "number of clusters: found 0, expected at least 1");
  EXPECT_EQ(
      message_of(signal, 4, {.cluster_count = 11, .component_count = 1}, usage),
      "more clusters than points: found 11, expected at most 10, one a point. Ask for fewer with "
      "--clusters.");
  EXPECT_EQ(message_of(signal, 4, {.cluster_count = 2, .component_count = 5}, usage),
            "more components than coefficients: found 5, expected at most 4. Ask for fewer with "
            "--components.");
  message_of(signal, 4, {.cluster_count = 2, .component_count = -1}, usage);
  message_of(signal, 4, {.cluster_count = 2, .component_count = 1, .iterations = 0}, usage);
  message_of({}, 4, {.cluster_count = 1}, ErrorKind::bad_input);
}

TEST(StaticEncoder, NamesTheFirstPointThatIsNotFinite) {
  auto signal = random_values(100000 * 4, 1);
  signal[70000 * 4 + 3] = std::nanf("");
  signal[90000 * 4] = INFINITY;
  const Options options{.cluster_count = 2, .component_count = 1};
  EXPECT_EQ(message_of(signal, 4, options, ErrorKind::bad_input),
            "point 70000, coefficient 3: the signal is not finite: found nan, expected a number");
}

TEST(Encoding, ReconstructsMeanPlusWeightedBasis) {
  const Encoding encoding{.point_count = 2,
                          .dimension = 2,
                          .cluster_count = 2,
                          .component_count = 1,
                          .means = {1, 2, 3, 4},
                          .bases = {1, 0, 0, 1},
                          .cluster_of_point = {1, 0},
                          .weights = {5, 7}};
  std::vector<float> row(2);
  reconstruct(encoding, 0, row);
  EXPECT_EQ(row, (std::vector<float>{3, 9}));
  reconstruct(encoding, 1, row);
  EXPECT_EQ(row, (std::vector<float>{8, 2}));
  EXPECT_EQ(point_errors(encoding, std::vector<float>{3, 9, 8, 4}), (std::vector<double>{0, 4}));
}

}  // namespace
}  // namespace prt::cpca
