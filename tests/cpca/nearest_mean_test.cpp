// The fused classification kernel against distances computed one by one, at every SIMD level.
#include "cpca/nearest_mean.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cpca/distance.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

std::vector<SimdLevel> levels_of_this_machine() {
  std::vector<SimdLevel> levels;
  for (SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level <= simd_level()) levels.push_back(level);
  }
  return levels;
}

std::vector<std::uint32_t> classify(const std::vector<float>& signal, std::size_t n,
                                    const std::vector<float>& means, SimdLevel level) {
  std::vector<std::uint32_t> labels(signal.size() / n);
  NearestMean({means.data(), means.size()}, {means.data(), n}, level)
      .classify(signal, 0, labels.size(), labels);
  return labels;
}

TEST(NearestMean, AgreesWithDistancesForAnyShape) {
  for (SimdLevel level : levels_of_this_machine()) {
    for (std::size_t n : {1u, 3u, 25u, 64u, 75u}) {
      for (std::size_t mean_count : {1u, 2u, 31u, 32u, 33u, 100u}) {
        for (std::size_t point_count : {1u, 13u, 14u, 15u, 200u}) {
          const auto signal = random_values(point_count * n, 1);
          const auto means = random_values(mean_count * n, 2);
          const auto labels = classify(signal, n, means, level);
          for (std::size_t p = 0; p < point_count; ++p) {
            const std::span<const float> x(&signal[p * n], n);
            ASSERT_LT(labels[p], mean_count);
            double least = squared_distance(x, {means.data(), n});
            for (std::size_t k = 1; k < mean_count; ++k) {
              least = std::min(least, squared_distance(x, {&means[k * n], n}));
            }
            EXPECT_NEAR(squared_distance(x, {&means[labels[p] * n], n}), least, 1e-5);
          }
        }
      }
    }
  }
}

TEST(NearestMean, OfEqualMeansTheLowestWins) {
  constexpr std::size_t n = 5;
  std::vector<float> means = random_values(n, 3);
  for (int copy = 1; copy < 70; ++copy) {
    for (std::size_t i = 0; i < n; ++i) means.push_back(means[i]);
  }
  const auto far = random_values(7 * n, 4);
  means.insert(means.begin(), far.begin(), far.end());
  const std::vector<float> point(means.begin() + 7 * n, means.begin() + 8 * n);
  for (SimdLevel level : levels_of_this_machine()) {
    EXPECT_EQ(classify(point, n, means, level)[0], 7u) << simd_level_name(level);
  }
}

TEST(NearestMean, DoesNotDependOnHowPointsAreSplit) {
  constexpr std::size_t n = 37, point_count = 301;
  const auto signal = make_signal(point_count, n), means = make_signal(40, n);
  const NearestMean nearest(means, {means.data(), n});
  std::vector<std::uint32_t> whole(point_count), parts(point_count);
  nearest.classify(signal, 0, point_count, whole);
  for (std::size_t begin = 0; begin < point_count;) {
    const std::size_t end = std::min(point_count, begin + 1 + begin % 17);
    nearest.classify(signal, begin, end, parts);
    begin = end;
  }
  EXPECT_EQ(whole, parts);
}

// Fused multiply-adds give both levels the same scores; the baseline rounds twice.
TEST(NearestMean, VectorLevelsAgreeBitForBit) {
  if (simd_level() != SimdLevel::avx512) GTEST_SKIP() << "needs AVX-512";
  constexpr std::size_t n = 75;
  const auto signal = make_signal(5000, n), means = make_signal(300, n, 3, 12);
  EXPECT_EQ(classify(signal, n, means, SimdLevel::avx512),
            classify(signal, n, means, SimdLevel::avx2));
}

// A signal far from the origin: without the common origin taken out, scores of 1e6 would drown
// differences of 1e-2.
TEST(NearestMean, KeepsPrecisionFarFromZero) {
  constexpr std::size_t n = 16;
  auto signal = random_values(400 * n, 5), means = random_values(20 * n, 6);
  for (float& value : signal) value += 100.0f;
  for (float& value : means) value += 100.0f;
  for (SimdLevel level : levels_of_this_machine()) {
    const auto labels = classify(signal, n, means, level);
    for (std::size_t p = 0; p < labels.size(); ++p) {
      const std::span<const float> x(&signal[p * n], n);
      const double found = squared_distance(x, {&means[labels[p] * n], n});
      for (std::size_t k = 0; k < 20; ++k) {
        EXPECT_LE(found, squared_distance(x, {&means[k * n], n}) + 2e-3);
      }
    }
  }
}

}  // namespace
}  // namespace prt::cpca
