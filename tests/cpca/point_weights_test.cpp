// Weights of points in all encoders.
#include <gtest/gtest.h>

#include "cpca/clusterer.h"
#include "cpca/encoder.h"
#include "cpca/quantizer.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

constexpr std::size_t kWeightedCount = 1500;
constexpr int kWeightedDimension = 128;

double weighted_error(const Encoded& encoded, const std::vector<float>& signal,
                      const std::vector<float>& weights) {
  const auto errors = point_errors(encoded.encoding, signal);
  double sum = 0.0;
  for (std::size_t p = 0; p < errors.size(); ++p) sum += double{weights[p]} * errors[p];
  return sum;
}

class PointWeights : public testing::TestWithParam<decltype(&encode_static)> {
 protected:
  const std::vector<float> signal_ = make_signal(kWeightedCount, kWeightedDimension, 6);
  Options options_{.cluster_count = 8, .component_count = 3, .iterations = 6};
};

TEST_P(PointWeights, ErrorsOfHeavyPointsFall) {
  std::vector<float> weights(kWeightedCount, 0.01f);
  for (std::size_t p = 0; p < kWeightedCount; p += 5) weights[p] = 10.0f;
  const Encoded plain = GetParam()(signal_, kWeightedDimension, options_);
  options_.point_weights = weights;
  const Encoded weighted = GetParam()(signal_, kWeightedDimension, options_);
  EXPECT_LT(weighted_error(weighted, signal_, weights),
            0.95 * weighted_error(plain, signal_, weights));
}

TEST_P(PointWeights, AllTheSameChangeLittle) {
  const std::vector<float> weights(kWeightedCount, 4.0f), ones(kWeightedCount, 1.0f);
  const double plain =
      weighted_error(GetParam()(signal_, kWeightedDimension, options_), signal_, ones);
  options_.point_weights = weights;
  const double weighted =
      weighted_error(GetParam()(signal_, kWeightedDimension, options_), signal_, ones);
  EXPECT_NEAR(weighted, plain, 0.01 * plain);
}

TEST_P(PointWeights, PointsThatWeighNothingDoNotMatter) {
  auto spoilt = signal_;
  std::vector<float> weights(kWeightedCount, 1.0f);
  for (std::size_t p = 0; p < 100; ++p) {
    weights[p] = 0.0f;
    for (std::size_t i = 0; i < kWeightedDimension; ++i) spoilt[p * kWeightedDimension + i] = 10.0f;
  }
  options_.cluster_count = 1;
  const std::span<const float> rest = std::span(signal_).subspan(100 * kWeightedDimension);
  const auto expected = point_errors(GetParam()(rest, kWeightedDimension, options_).encoding, rest);
  options_.point_weights = weights;
  const auto errors =
      point_errors(GetParam()(spoilt, kWeightedDimension, options_).encoding, spoilt);
  for (std::size_t p = 0; p < expected.size(); ++p) {
    EXPECT_NEAR(errors[100 + p], expected[p], 1e-3 * (expected[p] + 1e-2));
  }
}

INSTANTIATE_TEST_SUITE_P(Encoders, PointWeights,
                         testing::Values(encode_static, encode_iterative, encode_adaptive));

// Of clusters that begin at the same place the second is empty: it goes to the point at 1, not to
// the one farthest away.
TEST(WeightlessPoints, TakeNoEmptyCluster) {
  std::vector<float> signal(10), weights(10, 1.0f);
  signal[3] = 1.0f;
  signal[7] = 100.0f;
  weights[7] = 0.0f;
  const std::vector<float> means(2);
  const Clustering quantized = quantize(signal, 1, means, 5, weights);
  EXPECT_EQ(quantized.means, (std::vector<float>{0.0f, 1.0f}));
  EXPECT_EQ(quantized.labels[3], 1u);
  Clusterer clusterer({signal.data(), signal.size(), 1, weights}, 1, means);
  EXPECT_EQ(clusterer.classify(true).moved_count, 1u);
  EXPECT_EQ(clusterer.labels()[3], 1u);
  EXPECT_EQ(clusterer.labels()[7], 0u);
}

}  // namespace
}  // namespace prt::cpca
