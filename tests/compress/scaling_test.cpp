#include "compress/scaling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compress/signal.h"
#include "cpca/encoder.h"
#include "cpca/signals.h"

namespace prt::compress {
namespace {

using cpca::WeightFormat;

TEST(Scaling, BringsAnySignalToOneAndBackBitForBit) {
  const auto signal = cpca::make_signal(50, 7);
  for (const float size : {1e-36f, 1e-30f, 1.0f, 1e30f, 1e37f}) {
    auto values = signal;
    for (float& value : values) value *= size;
    const auto before = values;
    const Scaling scaling(values, {});
    scaling.apply(values);
    float greatest = 0.0f;
    for (const float value : values) greatest = std::max(greatest, std::abs(value));
    EXPECT_GE(greatest, 1.0f);
    EXPECT_LT(greatest, 2.0f);
    scaling.undo(values);
    EXPECT_EQ(values, before);
  }
  std::vector<float> zeros(6);
  Scaling(zeros, {}).apply(zeros);
  EXPECT_EQ(zeros, std::vector<float>(6));
}

TEST(Scaling, GivesTheEncodingOfTheSignalThatItWas) {
  const auto plain = cpca::make_signal(300, 10);
  const cpca::Options options{.cluster_count = 8, .component_count = 2, .iterations = 5};
  const double expected =
      measure(cpca::encode_iterative(plain, 10, options).encoding, plain, {}).relative_rmse();
  for (const int exponent : {-100, -40, 0, 40, 120}) {
    auto signal = plain;
    for (float& value : signal) value = std::ldexp(value, exponent);
    auto scaled = signal;
    const Scaling scaling(scaled, {});
    scaling.apply(scaled);
    cpca::Encoding encoding = cpca::encode_iterative(scaled, 10, options).encoding;
    scaling.undo(WeightFormat::float32, encoding);
    EXPECT_NEAR(measure(encoding, signal, {}).relative_rmse(), expected, 1e-6 * expected)
        << exponent;
  }
}

TEST(Scaling, MakesPlainErrorsWeightedOnes) {
  auto signal = cpca::make_signal(300, 4);
  const auto original = signal;
  const std::vector<float> coefficients{1e6f, 0.25f, 3.0f, 1e-6f};
  const Scaling scaling(signal, coefficients);
  scaling.apply(signal);
  for (const WeightFormat format :
       {WeightFormat::float32, WeightFormat::float16, WeightFormat::unorm16}) {
    cpca::Encoding encoding =
        cpca::encode_static(signal, 4, {.cluster_count = 5, .component_count = 1}).encoding;
    cpca::convert_weights(format, encoding);
    const Errors scaled = measure(encoding, signal, {});
    scaling.undo(format, encoding);
    const Errors weighted = measure(encoding, original, {.coefficients = coefficients});
    EXPECT_NEAR(weighted.squared, scaling.square() * scaled.squared, 1e-4 * weighted.squared);
    EXPECT_NEAR(weighted.energy, scaling.square() * scaled.energy, 1e-4 * weighted.energy);
    EXPECT_NEAR(weighted.relative_max(), scaled.relative_max(), 1e-4 * scaled.relative_max());
  }
}

TEST(Measure, IsTheDefinition) {
  const cpca::Encoding encoding{.point_count = 2,
                                .dimension = 2,
                                .cluster_count = 1,
                                .component_count = 1,
                                .means = {1, 2},
                                .bases = {0, 1},
                                .cluster_of_point = {0, 0},
                                .weights = {3, 0}};
  const std::vector<float> signal{3, 4, 1, 3};  // decoded: 1 5, 1 2
  const Errors plain = measure(encoding, signal, {});
  EXPECT_DOUBLE_EQ(plain.squared, 6.0);
  EXPECT_DOUBLE_EQ(plain.energy, 35.0);
  EXPECT_DOUBLE_EQ(plain.largest, 5.0);
  EXPECT_DOUBLE_EQ(plain.relative_rmse(), std::sqrt(6.0 / 35.0));
  EXPECT_DOUBLE_EQ(plain.relative_max(), std::sqrt(5.0 * 2.0 / 35.0));
  const std::vector<float> points{0.5f, 4.0f}, coefficients{2.0f, 10.0f};
  const Errors weighted = measure(encoding, signal, {points, coefficients});
  EXPECT_DOUBLE_EQ(weighted.squared, 0.5 * 18.0 + 4.0 * 10.0);
  EXPECT_DOUBLE_EQ(weighted.energy, 0.5 * (18.0 + 160.0) + 4.0 * (2.0 + 90.0));
  EXPECT_DOUBLE_EQ(weighted.largest, 40.0);
}

}  // namespace
}  // namespace prt::compress
