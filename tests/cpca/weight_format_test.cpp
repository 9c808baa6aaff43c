#include "cpca/weight_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "cpca/encoder.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

constexpr int kFormatDimension = 20;

Encoding encode(const std::vector<float>& signal, int components) {
  return encode_static(signal, kFormatDimension,
                       {.cluster_count = 6, .component_count = components})
      .encoding;
}

double error_of(const Encoding& encoding, const std::vector<float>& signal) {
  const auto errors = point_errors(encoding, signal);
  return std::accumulate(errors.begin(), errors.end(), 0.0);
}

TEST(NormalizeWeights, MovesNoPointByMoreThanHalfAStepInEveryComponent) {
  const auto signal = make_signal(900, kFormatDimension);
  const Encoding before = encode(signal, 4);
  for (const WeightFormat format : {WeightFormat::unorm16, WeightFormat::unorm8}) {
    Encoding after = before;
    normalize_weights(format, after);
    std::vector<float> expected(kFormatDimension), found(kFormatDimension);
    for (std::size_t p = 0; p < before.point_count; ++p) {
      double bound = 0.0;  // half a step is half of |x_i| / greatest
      for (int i = 0; i < 4; ++i) {
        const float weight = after.weights[4 * p + static_cast<std::size_t>(i)];
        EXPECT_GE(weight, 0.0f);
        EXPECT_LE(weight, 1.0f);
        const float whole = weight * greatest(format);
        EXPECT_NEAR(whole, std::round(whole), 1e-2f);
        const auto basis = after.basis(static_cast<int>(after.cluster_of_point[p]), i);
        const double square = std::inner_product(basis.begin(), basis.end(), basis.begin(), 0.0);
        bound += square / (4.0 * greatest(format) * greatest(format));
      }
      reconstruct(before, p, expected);
      reconstruct(after, p, found);
      double moved = 0.0;
      for (std::size_t j = 0; j < kFormatDimension; ++j) {
        moved += std::pow(double{found[j]} - double{expected[j]}, 2);
      }
      EXPECT_LE(std::sqrt(moved), std::sqrt(bound) + 1e-6);
    }
  }
}

TEST(NormalizeWeights, ReachesZeroAndOneAndFoldsConstantWeightsIntoTheMean) {
  Encoding encoding{.point_count = 3,
                    .dimension = 2,
                    .cluster_count = 1,
                    .component_count = 2,
                    .means = {1, 2},
                    .bases = {1, 0, 0, 1},
                    .cluster_of_point = {0, 0, 0},
                    .weights = {-2, 5, 2, 5, 1, 5}};
  normalize_weights(WeightFormat::unorm8, encoding);
  EXPECT_EQ(encoding.weights, std::vector<float>({0, 0, 1, 0, 191.0f / 255.0f, 0}));
  EXPECT_EQ(encoding.means, std::vector<float>({-1, 7}));
  EXPECT_EQ(encoding.bases, std::vector<float>({4, 0, 0, 0}));
}

TEST(NormalizeWeights, LeavesWhatAClusterDoesNotHave) {
  const auto signal = make_signal(900, kFormatDimension);
  Encoding encoding = encode(signal, 3);
  encoding.component_counts = {3, 0, 1, 2, 3, 3};
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      encoding.weights[3 * p + i] = 0.0f;
    }
  }
  const double before = error_of(encoding, signal);
  Encoding empty_last = encoding;  // and a cluster without points
  normalize_weights(WeightFormat::unorm16, encoding);
  EXPECT_NEAR(error_of(encoding, signal), before, 1e-4 * before);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      EXPECT_EQ(encoding.weights[3 * p + i], 0.0f);
    }
  }
  const std::vector<float> last_mean(empty_last.mean(5).begin(), empty_last.mean(5).end());
  for (std::uint32_t& cluster : empty_last.cluster_of_point) cluster = std::min(cluster, 4u);
  normalize_weights(WeightFormat::unorm8, empty_last);
  EXPECT_EQ(std::vector<float>(empty_last.mean(5).begin(), empty_last.mean(5).end()), last_mean);
}

TEST(ChooseWeights, TakesTheSmallestThatAddsUnderOnePercent) {
  // Noise of a few strengths: the better the encoding, the finer its weights must be.
  const auto exact = make_signal(900, kFormatDimension);
  const Encoding best = encode(exact, 8);
  std::vector<WeightFormat> chosen;
  for (const float noise : {0.1f, 1e-4f, 1e-7f}) {
    auto signal = exact;
    const auto added = random_values(signal.size(), 3);
    for (std::size_t p = 0; p < 900; ++p) {
      const auto row = std::span(signal).subspan(p * kFormatDimension, kFormatDimension);
      reconstruct(best, p, row);
      for (std::size_t j = 0; j < kFormatDimension; ++j)
        row[j] += noise * added[p * kFormatDimension + j];
    }
    Encoding encoding = best;
    const double before = error_of(encoding, signal);
    chosen.push_back(choose_weights(signal, {}, encoding));
    EXPECT_LE(error_of(encoding, signal), 1.01 * before);
  }
  EXPECT_EQ(chosen,
            std::vector({WeightFormat::unorm8, WeightFormat::unorm16, WeightFormat::float32}));
}

TEST(ChooseWeights, DoesAsItIsTold) {
  const auto signal = make_signal(300, kFormatDimension);
  for (const WeightFormat format :
       {WeightFormat::float32, WeightFormat::unorm16, WeightFormat::unorm8}) {
    Encoding encoding = encode(signal, 2), expected = encoding;
    EXPECT_EQ(choose_weights(signal, format, encoding), format);
    normalize_weights(format, expected);
    EXPECT_EQ(encoding.weights, expected.weights);
  }
}

}  // namespace
}  // namespace prt::cpca
