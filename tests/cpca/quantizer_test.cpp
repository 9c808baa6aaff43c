#include "cpca/quantizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/parallel.h"
#include "cpca/distance.h"
#include "cpca/seeding.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

double squared_error(const std::vector<float>& signal, std::size_t n, const Clustering& clusters) {
  double sum = 0.0;
  for (std::size_t p = 0; p < clusters.labels.size(); ++p) {
    sum += squared_distance({&signal[p * n], n}, {&clusters.means[clusters.labels[p] * n], n});
  }
  return sum;
}

/// k-means as a textbook has it, in double.
Clustering plain_quantize(const std::vector<float>& signal, std::size_t n,
                          const std::vector<float>& seeds, int iterations) {
  const std::size_t point_count = signal.size() / n, cluster_count = seeds.size() / n;
  std::vector<double> means(seeds.begin(), seeds.end());
  Clustering result{.means = {}, .labels = std::vector<std::uint32_t>(point_count, ~0u)};
  for (bool moved = true; moved && result.iterations < iterations; ++result.iterations) {
    moved = false;
    for (std::size_t p = 0; p < point_count; ++p) {
      double least = std::numeric_limits<double>::infinity();
      std::uint32_t label = 0;
      for (std::uint32_t k = 0; k < cluster_count; ++k) {
        double distance = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
          const double difference = double{signal[p * n + i]} - means[k * n + i];
          distance += difference * difference;
        }
        if (distance < least) least = distance, label = k;
      }
      moved |= result.labels[p] != label;
      result.labels[p] = label;
    }
    std::vector<double> counts(cluster_count);
    std::fill(means.begin(), means.end(), 0.0);
    for (std::size_t p = 0; p < point_count; ++p) {
      counts[result.labels[p]] += 1.0;
      for (std::size_t i = 0; i < n; ++i) means[result.labels[p] * n + i] += signal[p * n + i];
    }
    for (std::size_t i = 0; i < means.size(); ++i) means[i] /= counts[i / n];
  }
  result.means.assign(means.begin(), means.end());
  return result;
}

TEST(Quantizer, AgreesWithThePlainMethodFromTheSameSeeds) {
  for (std::size_t n : {3u, 25u, 75u}) {
    const auto signal = make_signal(2000, n);
    const auto seeds = seed_means(signal, n, 20, 5);
    const Clustering fast = quantize(signal, n, seeds, 12);
    const Clustering plain = plain_quantize(signal, n, seeds, 12);
    EXPECT_EQ(fast.labels, plain.labels);
    EXPECT_EQ(fast.iterations, plain.iterations);
    const double error = squared_error(signal, n, plain);
    EXPECT_NEAR(squared_error(signal, n, fast), error, 1e-5 * error);
  }
}

TEST(Quantizer, MeansAreThoseOfTheirPoints) {
  constexpr std::size_t n = 10;
  const auto signal = make_signal(500, n);
  const Clustering clusters = quantize(signal, n, seed_means(signal, n, 7, 1), 4);
  for (std::uint32_t k = 0; k < 7; ++k) {
    const auto count = std::count(clusters.labels.begin(), clusters.labels.end(), k);
    ASSERT_GT(count, 0);
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t p = 0; p < 500; ++p) {
        if (clusters.labels[p] == k) sum += double{signal[p * n + i]};
      }
      EXPECT_NEAR(clusters.means[k * n + i], sum / static_cast<double>(count), 1e-6);
    }
  }
}

TEST(Quantizer, ErrorDoesNotRiseWithIterations) {
  constexpr std::size_t n = 25;
  const auto signal = make_signal(1500, n);
  const auto seeds = seed_means(signal, n, 30, 2);
  double last = std::numeric_limits<double>::infinity();
  for (int iterations = 1; iterations < 12; ++iterations) {
    const double error = squared_error(signal, n, quantize(signal, n, seeds, iterations));
    EXPECT_LE(error, last * (1.0 + 1e-6));
    last = error;
  }
}

TEST(Quantizer, StopsWhenNoPointMoves) {
  const std::vector<float> signal{0, 1, 10, 11};
  const Clustering clusters = quantize(signal, 1, {0, 10}, 100);
  EXPECT_EQ(clusters.iterations, 2);
  EXPECT_EQ(clusters.means, (std::vector<float>{0.5f, 10.5f}));
  EXPECT_EQ(clusters.labels, (std::vector<std::uint32_t>{0, 0, 1, 1}));
}

TEST(Quantizer, RefillsEmptyClustersFromTheWorstPoints) {
  // The third seed is nobody's nearest; the point at 30 is worst approximated.
  const std::vector<float> signal{0, 1, 10, 11, 12, 30};
  const Clustering clusters = quantize(signal, 1, {0, 10, 1000}, 20);
  EXPECT_EQ(clusters.labels, (std::vector<std::uint32_t>{0, 0, 1, 1, 1, 2}));
  EXPECT_EQ(clusters.means, (std::vector<float>{0.5f, 11.0f, 30.0f}));
}

TEST(Quantizer, FillsManyEmptyClustersAtOnce) {
  constexpr std::size_t n = 4, cluster_count = 50;
  const auto signal = make_signal(200, n);
  std::vector<float> seeds(cluster_count * n, 1e3f);  // all the same: one takes every point
  const Clustering clusters = quantize(signal, n, seeds, 30);
  for (std::uint32_t k = 0; k < cluster_count; ++k) {
    EXPECT_GT(std::count(clusters.labels.begin(), clusters.labels.end(), k), 0) << k;
  }
}

TEST(Quantizer, LeavesClustersEmptyWhenPointsAreTooAlike) {
  const std::vector<float> signal{2, 2, 2, 5, 5};
  const Clustering clusters = quantize(signal, 1, {2, 2, 2, 2}, 20);
  EXPECT_EQ(squared_error(signal, 1, clusters), 0.0);
}

TEST(Seeding, DrawsDistinctPointsOfTheSignal) {
  constexpr std::size_t n = 6;
  const auto signal = make_signal(300, n);
  const auto means = seed_means(signal, n, 40, 9);
  ASSERT_EQ(means.size(), 40 * n);
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < 40; ++k) {
    for (std::size_t p = 0; p < 300; ++p) {
      if (std::equal(&means[k * n], &means[k * n] + n, &signal[p * n])) found.push_back(p);
    }
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found.size(), 40u);
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
}

TEST(Seeding, FindsEveryFarGroup) {
  // Ten groups a thousand widths apart: chance would miss some nine times out of ten.
  std::vector<float> signal;
  for (int p = 0; p < 1000; ++p) {
    signal.push_back(static_cast<float>(1000 * (p % 10)) + 0.001f * static_cast<float>(p));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    auto means = seed_means(signal, 1, 10, seed);
    std::sort(means.begin(), means.end());
    for (int g = 0; g < 10; ++g) EXPECT_NEAR(means[static_cast<std::size_t>(g)], 1000 * g, 1.1);
  }
}

TEST(Seeding, TakesNoPointThatWeighsNothing) {
  std::vector<float> signal, weights;
  for (int p = 0; p < 1200; ++p) {  // of two blocks in the first only one in a hundred weighs
    signal.push_back(static_cast<float>(p));
    weights.push_back(p >= 600 || p % 100 == 50 ? 1.0f : 0.0f);
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const float mean : seed_means(signal, 1, 20, seed, weights)) {
      EXPECT_GT(weights[static_cast<std::size_t>(mean)], 0.0f) << mean;
    }
  }
}

TEST(Seeding, DependsOnTheSeedAndNotOnThreads) {
  const auto signal = make_signal(5000, 25);
  set_thread_count(1);
  const auto one = seed_means(signal, 25, 30, 3);
  set_thread_count(3);
  EXPECT_EQ(seed_means(signal, 25, 30, 3), one);
  set_thread_count(0);
  EXPECT_NE(seed_means(signal, 25, 30, 4), one);
}

}  // namespace
}  // namespace prt::cpca
