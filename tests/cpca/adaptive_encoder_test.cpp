// Adaptive CPCA: its budget, and what it is for.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "cpca/allocation.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

std::size_t weight_count(const Encoding& encoding) {
  std::size_t count = 0;
  for (const std::uint32_t k : encoding.cluster_of_point) count += encoding.component_counts[k];
  return count;
}

TEST(Allocate, TakesTheGreatestSavingsThatFit) {
  // Savings a point: 10, 4 | 6, 5 | 9, 1 for clusters of 1, 2 and 4 points.
  const std::vector<double> variances{10, 4, 12, 10, 36, 4};
  const std::vector<std::size_t> points{1, 2, 4};
  using Counts = std::vector<std::uint32_t>;
  EXPECT_EQ(allocate(variances, 2, points, 0).counts, (Counts{0, 0, 0}));
  EXPECT_EQ(allocate(variances, 2, points, 5).counts, (Counts{1, 0, 1}));
  EXPECT_EQ(allocate(variances, 2, points, 7).counts, (Counts{1, 1, 1}));
  EXPECT_EQ(allocate(variances, 2, points, 9).counts, (Counts{1, 2, 1}));
  EXPECT_EQ(allocate(variances, 2, points, 9).cost, 5.0);
  EXPECT_EQ(allocate(variances, 2, points, 100).counts, (Counts{2, 2, 2}));
  // The second vector does not fit; what comes after it in its cluster is no first choice either.
  EXPECT_EQ(allocate(std::vector<double>{9, 8, 7, 1}, 2, std::vector<std::size_t>{3, 1}, 4).counts,
            (Counts{1, 1}));
  EXPECT_EQ(allocate(std::vector<double>{0, 0}, 2, std::vector<std::size_t>{3}, 9).counts,
            (Counts{0}));
}

TEST(AdaptiveEncoder, IsBetterThanIterativeForTheSameWeights) {
  const struct {
    std::size_t point_count, dimension, group_count;
    Options options;
  } cases[] = {{3000, 25, 6, {.cluster_count = 60, .component_count = 4, .iterations = 10}},
               {2000, 80, 5, {.cluster_count = 50, .component_count = 3, .iterations = 10}},
               {2000, 128, 1, {.cluster_count = 40, .component_count = 3, .iterations = 10}},
               {1600, 25, 1, {.cluster_count = 8, .component_count = 2, .iterations = 10}}};
  for (const auto& test : cases) {
    const auto signal = make_uneven_signal(test.point_count, test.dimension, test.group_count);
    const auto n = static_cast<int>(test.dimension);
    const Encoded adaptive = encode_adaptive(signal, n, test.options);
    const Encoding& encoding = adaptive.encoding;
    EXPECT_LT(error_of(adaptive, signal),
              0.95 * error_of(encode_iterative(signal, n, test.options), signal));
    EXPECT_LE(weight_count(encoding),
              test.point_count * static_cast<std::size_t>(test.options.component_count));
    EXPECT_LE(encoding.component_count, 2 * test.options.component_count);
    EXPECT_EQ(*std::max_element(encoding.component_counts.begin(), encoding.component_counts.end()),
              static_cast<std::uint32_t>(encoding.component_count));
  }
}

TEST(AdaptiveEncoder, IsNeverWorseThanIterative) {
  // Clusters that are all alike leave nothing to gain; one iteration leaves no time to.
  for (int iterations : {1, 2, 8}) {
    for (std::uint64_t seed : {1, 2, 3}) {
      const Options options{
          .cluster_count = 12, .component_count = 3, .iterations = iterations, .seed = seed};
      for (const auto& signal : {random_values(500 * 20, seed), make_signal(500, 20, 12, seed)}) {
        EXPECT_LE(error_of(encode_adaptive(signal, 20, options), signal),
                  (1.0 + 1e-5) * error_of(encode_iterative(signal, 20, options), signal));
      }
    }
  }
}

TEST(AdaptiveEncoder, KeepsToTheMaximum) {
  const auto signal = make_uneven_signal(1000, 30, 4);
  const Options options{
      .cluster_count = 20, .component_count = 2, .iterations = 5, .max_component_count = 3};
  const Encoding encoding = encode_adaptive(signal, 30, options).encoding;
  EXPECT_EQ(encoding.component_count, 3);
  EXPECT_EQ(encoding.bases.size(), 20u * 3u * 30u);
  EXPECT_EQ(encoding.weights.size(), 1000u * 3u);
  for (std::size_t p = 0; p < 1000; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      EXPECT_EQ(encoding.weights[p * 3 + i], 0.0f);
    }
  }
}

TEST(AdaptiveEncoder, SameBytesForAnyThreadCount) {
  const auto signal = make_signal(4000, 128, 5);
  const auto encode = [&](int threads) {
    set_thread_count(threads);
    const Options options{.cluster_count = 50, .component_count = 3, .iterations = 3};
    return encode_adaptive(signal, 128, options).encoding;
  };
  const Encoding one = encode(1), two = encode(2);
  set_thread_count(0);
  EXPECT_EQ(one.means, two.means);
  EXPECT_EQ(one.bases, two.bases);
  EXPECT_EQ(one.component_counts, two.component_counts);
  EXPECT_EQ(one.cluster_of_point, two.cluster_of_point);
  EXPECT_EQ(one.weights, two.weights);
}

TEST(AdaptiveEncoder, DegenerateSignalsAreExact) {
  for (const DegenerateCase& test : degenerate_cases()) {
    const Encoded encoded = encode_adaptive(test.signal, 9, test.options);
    EXPECT_LT(summarize(point_errors(encoded.encoding, test.signal), test.signal).relative_rmse(),
              1e-6)
        << test.name;
  }
}

}  // namespace
}  // namespace prt::cpca
