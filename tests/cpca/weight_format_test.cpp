#include "cpca/weight_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "core/error.h"
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

TEST(ConvertWeights, NormalizesMovingNoPointByMoreThanHalfAStepInEveryComponent) {
  const auto signal = make_signal(900, kFormatDimension);
  const Encoding before = encode(signal, 4);
  for (const WeightFormat format : {WeightFormat::unorm16, WeightFormat::unorm8}) {
    Encoding after = before;
    convert_weights(format, after);
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

TEST(ConvertWeights, NormalizedReachZeroAndOneAndFoldConstantOnesIntoTheMean) {
  Encoding encoding{.point_count = 3,
                    .dimension = 2,
                    .cluster_count = 1,
                    .component_count = 2,
                    .means = {1, 2},
                    .bases = {1, 0, 0, 1},
                    .cluster_of_point = {0, 0, 0},
                    .weights = {-2, 5, 2, 5, 1, 5}};
  convert_weights(WeightFormat::unorm8, encoding);
  EXPECT_EQ(encoding.weights, std::vector<float>({0, 0, 1, 0, 191.0f / 255.0f, 0}));
  EXPECT_EQ(encoding.means, std::vector<float>({-1, 7}));
  EXPECT_EQ(encoding.bases, std::vector<float>({4, 0, 0, 0}));
}

TEST(ConvertWeights, LeavesWhatAClusterDoesNotHave) {
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
  convert_weights(WeightFormat::unorm16, encoding);
  EXPECT_NEAR(error_of(encoding, signal), before, 1e-4 * before);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      EXPECT_EQ(encoding.weights[3 * p + i], 0.0f);
    }
  }
  const std::vector<float> last_mean(empty_last.mean(5).begin(), empty_last.mean(5).end());
  for (std::uint32_t& cluster : empty_last.cluster_of_point) cluster = std::min(cluster, 4u);
  convert_weights(WeightFormat::unorm8, empty_last);
  EXPECT_EQ(std::vector<float>(empty_last.mean(5).begin(), empty_last.mean(5).end()), last_mean);
}

/// Bits of the half floats that stand for the weights.
std::vector<std::uint16_t> half_bits(const std::vector<float>& weights) {
  const std::vector<std::byte> bytes = stored_weights(WeightFormat::float16, weights);
  std::vector<std::uint16_t> bits(weights.size());
  EXPECT_EQ(bytes.size(), 2 * bits.size());
  std::memcpy(bits.data(), bytes.data(), bytes.size());
  return bits;
}

/// One component, a cluster, and these weights.
Encoding with_weights(std::vector<float> weights) {
  return {.point_count = weights.size(),
          .dimension = 1,
          .cluster_count = 1,
          .component_count = 1,
          .means = {0},
          .bases = {1},
          .cluster_of_point = std::vector<std::uint32_t>(weights.size()),
          .weights = std::move(weights)};
}

TEST(ConvertWeights, RoundsToTheNearestHalfFloatTiesToEven) {
  const float step = std::ldexp(1.0f, -10);
  const struct {
    float weight;
    std::uint16_t bits;
    float rounded;
  } cases[] = {
      {0.0f, 0x0000, 0.0f},
      {-0.0f, 0x8000, -0.0f},
      {1.0f, 0x3c00, 1.0f},
      {-2.5f, 0xc100, -2.5f},
      {1.0f + 0.49f * step, 0x3c00, 1.0f},
      {1.0f + 0.5f * step, 0x3c00, 1.0f},                // to even
      {1.0f + 1.5f * step, 0x3c02, 1.0f + 2.0f * step},  // to even
      {1.0f + 0.51f * step, 0x3c01, 1.0f + step},
      {65504.0f, 0x7bff, 65504.0f},
      {-65519.0f, 0xfbff, -65504.0f},
      {std::ldexp(1.0f, -14), 0x0400, std::ldexp(1.0f, -14)},  // the least normal one
      {std::ldexp(1.0f, -24), 0x0001, std::ldexp(1.0f, -24)},  // the least of all
      {std::ldexp(1.0f, -25), 0x0000, 0.0f},                   // to even
      {std::ldexp(1.25f, -25), 0x0001, std::ldexp(1.0f, -24)},
  };
  for (const auto& [weight, bits, rounded] : cases) {
    Encoding encoding = with_weights({weight});
    convert_weights(WeightFormat::float16, encoding);
    EXPECT_EQ(encoding.weights[0], rounded) << weight;
    EXPECT_EQ(half_bits(encoding.weights)[0], bits) << weight;
    EXPECT_EQ(weight_from_half(bits), rounded);
  }
}

TEST(ConvertWeights, RefusesWhatIsBeyondHalfFloats) {
  for (const float weight : {65520.0f, -1e30f, std::numeric_limits<float>::infinity()}) {
    Encoding encoding = with_weights({1.0f, weight});
    try {
      convert_weights(WeightFormat::float16, encoding);
      ADD_FAILURE() << weight;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::failed);
      EXPECT_PRED_FORMAT2(testing::IsSubstring, "expected at most 65504. Store weights as float",
                          error.what());
    }
  }
}

TEST(ConvertWeights, RoundsByAtMostHalfAStepAndLeavesMeansAndVectors) {
  const auto signal = make_signal(900, kFormatDimension);
  const Encoding before = encode(signal, 4);
  Encoding after = before;
  convert_weights(WeightFormat::float16, after);
  EXPECT_EQ(after.means, before.means);
  EXPECT_EQ(after.bases, before.bases);
  std::size_t changed_count = 0;
  for (std::size_t i = 0; i < before.weights.size(); ++i) {
    const float size = std::abs(before.weights[i]);
    EXPECT_LE(std::abs(after.weights[i] - before.weights[i]),
              std::max(std::ldexp(size, -11), std::ldexp(1.0f, -25)));
    changed_count += after.weights[i] != before.weights[i];
  }
  EXPECT_GT(changed_count, before.weights.size() / 2);
}

TEST(StoredWeights, AreTheBitsOfEveryHalfFloat) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const float weight = weight_from_half(static_cast<std::uint16_t>(bits));
    const std::uint32_t exponent = bits >> 10 & 31, fraction = bits & 1023;
    ASSERT_EQ(std::isfinite(weight), exponent < 31) << bits;
    if (!std::isfinite(weight)) continue;
    const float size = exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(1024 + fraction),
                                                  static_cast<int>(exponent) - 25);
    ASSERT_EQ(weight, bits & 0x8000 ? -size : size) << bits;
    ASSERT_EQ(half_bits({weight})[0], bits);
  }
}

TEST(StoredWeights, AreNumbersOfTheFormat) {
  const std::vector<float> weights{0.0f, 1.0f, 3.0f / 255.0f};
  const auto bytes = [&](WeightFormat format) {
    std::vector<int> numbers;
    for (const std::byte byte : stored_weights(format, weights))
      numbers.push_back(std::to_integer<int>(byte));
    EXPECT_EQ(numbers.size(), weights.size() * bytes_of(format));
    return numbers;
  };
  EXPECT_EQ(bytes(WeightFormat::unorm8), std::vector<int>({0, 255, 3}));
  EXPECT_EQ(bytes(WeightFormat::unorm16), std::vector<int>({0, 0, 255, 255, 3, 3}));
  EXPECT_EQ(bytes(WeightFormat::float32),
            std::vector<int>({0, 0, 0, 0, 0, 0, 0x80, 0x3f, 0xc1, 0xc0, 0x40, 0x3c}));
}

TEST(ChooseWeights, TakesHalfFloatsWhereFewWeightsAreFarAboveTheOthers) {
  // Two outliers stretch the range of every cluster; 16 bits of it are coarser than 11 of a weight.
  auto weights = random_values(2000, 3);
  weights[7] = 300.0f;
  weights[8] = -300.0f;
  const Encoding exact = with_weights(weights);
  const auto noise = random_values(weights.size(), 4);
  const auto chosen = [&](float strength, Encoding encoding) {
    std::vector<float> signal = encoding.weights;
    for (std::size_t i = 0; i < signal.size(); ++i) signal[i] += strength * noise[i];
    const WeightFormat format = choose_weights(signal, {}, encoding);
    Encoding expected = exact;
    convert_weights(format, expected);
    EXPECT_EQ(encoding.weights, expected.weights);
    return format;
  };
  EXPECT_EQ(chosen(1e-2f, exact), WeightFormat::float16);
  EXPECT_EQ(chosen(1e-6f, exact), WeightFormat::float32);
}

TEST(ChooseWeights, LeavesHalfFloatsAloneWhereTheyDoNotReach) {
  auto weights = random_values(2000, 3);
  weights[7] = 70000.0f;
  Encoding encoding = with_weights(weights);
  EXPECT_EQ(choose_weights(weights, {}, encoding), WeightFormat::float32);
  EXPECT_EQ(encoding.weights, weights);
  EXPECT_THROW(choose_weights(weights, WeightFormat::float16, encoding), Error);
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
  for (const WeightFormat format : {WeightFormat::float32, WeightFormat::float16,
                                    WeightFormat::unorm16, WeightFormat::unorm8}) {
    Encoding encoding = encode(signal, 2), expected = encoding;
    EXPECT_EQ(choose_weights(signal, format, encoding), format);
    convert_weights(format, expected);
    EXPECT_EQ(encoding.weights, expected.weights);
  }
}

}  // namespace
}  // namespace prt::cpca
