// Encodings that are brought within a limit for every point.
#include "cpca/tighten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/parallel.h"
#include "cpca/error_limits.h"
#include "cpca/method.h"
#include "cpca/surface.h"

namespace prt::cpca {
namespace {

constexpr int kDimension = 20;
constexpr int kEnough = 1000;

double worst(const Encoded& encoded, std::span<const float> signal,
             std::span<const float> weights = {}) {
  const auto errors = weighted_errors(encoded.encoding, signal, weights);
  return *std::max_element(errors.begin(), errors.end());
}

/// Two families of points along two lines each, which two clusters approximate all but exactly.
std::vector<float> make_lines(std::size_t point_count) {
  std::vector<float> signal(point_count * kDimension);
  for (std::size_t p = 0; p < point_count; ++p) {
    signal[p * kDimension + p % 2] = 1.0f + 0.01f * static_cast<float>(p % 50);
  }
  return signal;
}

TEST(Tighten, BringsEveryPointWithinTheLimitWithFewerClustersThanAPlainEncoding) {
  const auto signal = make_surface(3000, kDimension);
  for (const int components : {0, 1, 3}) {
    const Options plain_options{.cluster_count = 150, .component_count = components};
    const double limit = worst(encode_iterative(signal, kDimension, plain_options), signal);
    const Options options{.cluster_count = 50, .component_count = components};
    Encoded encoded = encode_iterative(signal, kDimension, options);
    const Encoded before = encoded;
    tighten(signal, limit, kEnough, options, encoded);
    EXPECT_LE(worst(encoded, signal), limit);
    EXPECT_LT(encoded.encoding.cluster_count, 150);
    EXPECT_EQ(encoded.encoding.component_count, components);
    EXPECT_GT(encoded.iterations, before.iterations);
    EXPECT_GT(encoded.flops, before.flops);
    EXPECT_EQ(encoded.stages.back().name, "tightening");
  }
}

TEST(Tighten, LeavesTheClustersOfWhatIsWithin) {
  const auto signal = make_surface(1000, kDimension);
  const Options options{.cluster_count = 30, .component_count = 2};
  Encoded encoded = encode_iterative(signal, kDimension, options);
  const double limit = 1.01 * worst(encoded, signal);
  tighten(signal, limit, kEnough, options, encoded);
  EXPECT_EQ(encoded.encoding.cluster_count, 30);
  EXPECT_LE(worst(encoded, signal), limit);
}

// However often it is there: a cluster more at most for each.
TEST(Tighten, APointOfItsOwnTakesOneCluster) {
  for (const std::size_t copies : {1u, 7u}) {
    auto signal = make_lines(600);
    for (std::size_t p = 0; p < copies; ++p) {
      for (std::size_t i = 0; i < kDimension; ++i) {
        signal[(100 + p) * kDimension + i] = i % 2 == 0 ? 0.2f : 0.0f;
      }
    }
    const Options options{.cluster_count = 2, .component_count = 1};
    Encoded encoded = encode_iterative(signal, kDimension, options);
    tighten(signal, 1e-4, kEnough, options, encoded);
    EXPECT_LE(worst(encoded, signal), 1e-4);
    EXPECT_LE(encoded.encoding.cluster_count, 4) << copies;
  }
}

TEST(Tighten, WeightsOfPointsAreOfTheirErrors) {
  const auto signal = make_surface(1500, kDimension);
  std::vector<float> weights(1500, 0.1f);
  for (std::size_t p = 0; p < weights.size(); p += 5) weights[p] = p % 2 == 0 ? 4.0f : 0.0f;
  const Options options{.cluster_count = 30, .component_count = 2, .point_weights = weights};
  Encoded encoded = encode_iterative(signal, kDimension, options);
  const double limit = 0.2 * worst(encoded, signal, weights);
  tighten(signal, limit, kEnough, options, encoded);
  EXPECT_LE(worst(encoded, signal, weights), limit);
  EXPECT_GT(worst(encoded, signal), limit);
}

TEST(Tighten, AdaptiveClustersHaveTheVectorsThatTheirPointsHave) {
  const auto signal = make_uneven_signal(1200, kDimension, 3);
  const Options options{.cluster_count = 12, .component_count = 2, .iterations = 8};
  Encoded encoded = encode_adaptive(signal, kDimension, options);
  const std::vector<std::uint32_t> before = encoded.encoding.component_counts;
  const double limit = 0.05 * worst(encoded, signal);
  tighten(signal, limit, kEnough, options, encoded);
  EXPECT_LE(worst(encoded, signal), limit);
  const std::vector<std::uint32_t>& after = encoded.encoding.component_counts;
  ASSERT_GT(after.size(), before.size());
  std::size_t fewer_count = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    EXPECT_LE(after[k], k < before.size() ? before[k] : *std::ranges::max_element(before));
    fewer_count += !std::ranges::count(before, after[k]);
    for (std::uint32_t v = 0; v < after[k]; ++v) {
      const auto vector = encoded.encoding.basis(static_cast<int>(k), static_cast<int>(v));
      EXPECT_NEAR(std::inner_product(vector.begin(), vector.end(), vector.begin(), 0.0), 1.0, 1e-5);
    }
  }
  EXPECT_GT(fewer_count, 0u);
}

TEST(Tighten, StopsBeforeThereAreTooManyClusters) {
  const auto noise = random_values(400 * kDimension, 1);
  const Options options{.cluster_count = 10, .component_count = 1, .iterations = 4};
  Encoded encoded = encode_iterative(noise, kDimension, options);
  tighten(noise, 1e-6, 25, options, encoded);
  EXPECT_LE(encoded.encoding.cluster_count, 25);
  EXPECT_GT(worst(encoded, noise), 1e-6);
}

TEST(Tighten, IsTheSameForAnyNumberOfThreads) {
  const auto signal = make_surface(2000, kDimension);
  const Options options{.cluster_count = 30, .component_count = 2, .iterations = 5};
  const Encoded plain = encode_iterative(signal, kDimension, options);
  const double limit = 0.2 * worst(plain, signal);
  Encoded one = plain, all = plain;
  set_thread_count(1);
  tighten(signal, limit, kEnough, options, one);
  set_thread_count(0);
  tighten(signal, limit, kEnough, options, all);
  EXPECT_EQ(one.encoding.cluster_of_point, all.encoding.cluster_of_point);
  EXPECT_EQ(one.encoding.means, all.encoding.means);
  EXPECT_EQ(one.encoding.bases, all.encoding.bases);
  EXPECT_EQ(one.encoding.weights, all.encoding.weights);
}

}  // namespace
}  // namespace prt::cpca
