// Searches on signals that few numbers hold exactly: of few different rows, of low rank, or at most
// as large as one cluster with all vectors.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/random.h"
#include "cpca/search.h"
#include "cpca/search_sample.h"
#include "cpca/surface.h"

namespace prt::cpca {
namespace {

constexpr int kExactDimension = 40;

/// Every point is one of a few rows, drawn at random.
std::vector<float> repeat_rows(int row_count, std::size_t point_count, int dimension) {
  const auto n = static_cast<std::size_t>(dimension);
  const auto rows = random_values(static_cast<std::size_t>(row_count) * n, 5);
  Pcg32 random(6);
  std::vector<float> signal;
  for (std::size_t p = 0; p < point_count; ++p) {
    const std::size_t row = random.below(static_cast<std::uint32_t>(row_count));
    signal.insert(signal.end(), &rows[row * n], &rows[row * n] + n);
  }
  return signal;
}

TEST(EqualRows, AreNumberedInOrder) {
  const std::vector<float> signal{1, 2, 3, 4, 1, 2, 1, 4, 3, 4};
  const auto rows = find_equal_rows(signal, 2, 3);
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->first, std::vector<std::uint32_t>({0, 1, 3}));
  EXPECT_EQ(rows->labels, std::vector<std::uint32_t>({0, 1, 0, 2, 1}));
  EXPECT_FALSE(find_equal_rows(signal, 2, 2));
}

TEST(EqualRows, AsASampleHaveTheErrorOfAllPoints) {
  const auto signal = repeat_rows(30, 700, 12);
  std::vector<float> weights(700);
  for (std::size_t p = 0; p < weights.size(); ++p) weights[p] = static_cast<float>(p % 5);
  Options options{.cluster_count = 4, .component_count = 2, .point_weights = weights};
  const EqualRows rows = *find_equal_rows(signal, 12, 700);
  const Sample sample = make_sample(signal, 12, options, rows);
  EXPECT_EQ(sample.count, 30u);
  options.point_weights = sample.point_weights;
  const Encoding few = encode_iterative(sample.signal, 12, options).encoding;
  Encoding all = few;
  all.point_count = 700;
  all.cluster_of_point.clear();
  all.weights.clear();
  for (const std::uint32_t row : rows.labels) {
    all.cluster_of_point.push_back(few.cluster_of_point[row]);
    all.weights.insert(all.weights.end(), &few.weights[row * 2], &few.weights[row * 2] + 2);
  }
  const double error = relative_error(all, signal, Norm::rmse, weights);
  EXPECT_NEAR(relative_error(few, sample.signal, Norm::rmse, sample.point_weights), error,
              1e-6 * error);
}

// Clusters with vectors, of which a sample may meet one row less, took up to seven times the bytes,
// and up to five encodings.
TEST(EncodeWithin, TakesAClusterForEachOfAFewRows) {
  struct Kind {
    int row_count;
    std::size_t point_count;
    int dimension;
  };
  for (const Kind& test : {Kind{7, 600, 25}, Kind{40, 1000, 50}}) {
    const auto signal = repeat_rows(test.row_count, test.point_count, test.dimension);
    std::vector<Bound> bounds{{.max_error = {}, .max_bytes = signal.size()}};
    for (const double max_error : {0.1, 0.001}) {
      for (const Norm norm : {Norm::rmse, Norm::maximum}) {
        bounds.push_back({.max_error = max_error, .norm = norm, .max_bytes = {}});
      }
    }
    const Choice each{test.row_count, 0};
    for (const Method method : {Method::fixed, Method::iterative, Method::adaptive}) {
      const Encoded alone =
          encode(method, signal, test.dimension,
                 {.cluster_count = each.cluster_count, .component_count = each.component_count});
      for (const Bound& bound : bounds) {
        const Found found = encode_within(bound, method, signal, test.dimension, {});
        EXPECT_EQ(found.trials[found.kept].choice, each);
        EXPECT_EQ(relative_error(found.encoded.encoding, signal, bound.norm), 0.0);
        EXPECT_LE(found.encoded.flops, alone.flops);
        EXPECT_LE(found.flops_cost(), 1.0);
      }
    }
  }
}

// Their mean by weights would be 0.
TEST(EncodeWithin, IsExactForRowsThatWeighNothing) {
  const auto signal = repeat_rows(7, 600, 25);
  const EqualRows rows = *find_equal_rows(signal, 25, 7);
  std::vector<float> weights(600, 1.0f);
  for (std::size_t p = 0; p < weights.size(); ++p) {
    if (rows.labels[p] == 3) weights[p] = 0.0f;
  }
  const Found found = encode_within({.max_error = 0.001, .max_bytes = {}}, Method::iterative,
                                    signal, 25, {.point_weights = weights});
  if (found.trials[found.kept].choice == Choice{7, 0}) {
    EXPECT_EQ(relative_error(found.encoded.encoding, signal, Norm::rmse), 0.0);
  }
  EXPECT_LE(relative_error(found.encoded.encoding, signal, Norm::rmse, weights), 0.001);
}

// With fewer vectors than all it is not exact, and others may do.
TEST(EncodeWithin, GoesOnAfterOneClusterOfAsManyVectorsAsThereMayBe) {
  constexpr std::size_t kCount = 900, kRank = 10;
  const auto weights = random_values(kCount * kRank, 41),
             axes = random_values(kRank * kExactDimension, 42);
  std::vector<float> signal = random_values(kCount * kExactDimension, 43);
  for (std::size_t p = 0; p < kCount; ++p) {
    for (std::size_t i = 0; i < kExactDimension; ++i) {
      float& value = signal[p * kExactDimension + i];
      value *= 0.1f;
      for (std::size_t r = 0; r < kRank; ++r) {
        value += weights[p * kRank + r] * axes[r * kExactDimension + i];
      }
    }
  }
  const Encoding one =
      encode_static(signal, kExactDimension, {.cluster_count = 1, .component_count = 8}).encoding;
  const double error = relative_error(one, signal, Norm::rmse);
  for (const Method method : {Method::iterative, Method::adaptive}) {
    for (const double share : {0.995, 0.985, 0.95}) {
      const Bound bound{
          .max_error = share * error, .max_bytes = {}, .cost = {.max_component_count = 8}};
      const Found found = encode_within(bound, method, signal, kExactDimension,
                                        {.iterations = 8, .max_component_count = 8});
      EXPECT_LE(relative_error(found.encoded.encoding, signal, Norm::rmse), share * error);
    }
  }
}

TEST(EncodeWithin, TakesFewerClustersThanRowsWhereErrorsMayBe) {
  const auto signal = repeat_rows(40, 1000, 50);
  const Bound bound{.max_error = 0.4, .max_bytes = {}};
  const Found found = encode_within(bound, Method::iterative, signal, 50, {});
  EXPECT_LE(relative_error(found.encoded.encoding, signal, Norm::rmse), 0.4);
  EXPECT_LT(bound.cost.bytes(found.encoded.encoding), bound.cost.bytes({1000, 50}, {38, 0}));
  EXPECT_LE(found.flops_cost(), 3.0);
}

// Noise in all directions, beside which a few clusters with many vectors are no smaller.
TEST(EncodeWithin, TakesNoMoreThanOneClusterWithAllVectors) {
  constexpr std::size_t kPointCount = 1500;
  std::vector<float> signal = random_values(kPointCount * kExactDimension, 3);
  const auto surface = make_surface(kPointCount, kExactDimension);
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] = surface[i] + 0.05f * signal[i];
  for (const Method method : {Method::fixed, Method::iterative}) {
    for (const double max_error : {1e-3, 1e-6}) {
      const Bound bound{.max_error = max_error, .max_bytes = {}};
      const Encoding found =
          encode_within(bound, method, signal, kExactDimension, {}).encoded.encoding;
      EXPECT_LE(relative_error(found, signal, Norm::rmse), max_error);
      EXPECT_LE(bound.cost.bytes(found),
                bound.cost.bytes({kPointCount, kExactDimension}, {1, kExactDimension}));
    }
  }
}

// A survey does not take more than 256 coefficients apart for one cluster with all vectors.
TEST(EncodeWithin, FailsOnlyBeyondOneClusterWithAllVectors) {
  constexpr int kDimension = 260;
  const auto noise = random_values(400 * kDimension, 2);
  Bound bound{.max_error = 1e-6, .max_bytes = {}, .cost = {.max_component_count = kDimension}};
  for (const Norm norm : {Norm::rmse, Norm::maximum}) {
    bound.norm = norm;
    const Found found =
        encode_within(bound, Method::iterative, noise, kDimension, {.iterations = 2});
    EXPECT_LE(relative_error(found.encoded.encoding, noise, norm), 1e-6);
    EXPECT_EQ(found.trials[found.kept].choice, (Choice{1, kDimension}));
  }
  bound.cost.max_component_count = 20;
  EXPECT_THROW(encode_within(bound, Method::iterative, noise, kDimension, {.iterations = 2}),
               Error);
}

// More clusters than are exact would not be more exact.
TEST(EncodeWithin, TakesTheLeastBytesThatAreExact) {
  const auto direction = random_values(25, 1);
  std::vector<float> constant, line;
  for (std::size_t p = 0; p < 600; ++p) {
    for (const float value : direction) {
      constant.push_back(value);
      line.push_back(0.3f + static_cast<float>(p) * value);
    }
  }
  for (const Method method : {Method::fixed, Method::iterative, Method::adaptive}) {
    for (const std::size_t max_bytes : {5000u, 50000u, 500000u}) {
      const Bound bound{.max_error = {}, .max_bytes = max_bytes};
      const Found one = encode_within(bound, method, constant, 25, {});
      EXPECT_EQ(one.trials[one.kept].choice, (Choice{1, 0}));
      EXPECT_LE(one.flops_cost(), 3.0);
      const Found vector = encode_within(bound, method, line, 25, {});
      EXPECT_EQ(vector.trials[vector.kept].choice, (Choice{1, 1}));
      EXPECT_LE(vector.flops_cost(), 3.0);
    }
  }
}

// Clusters tell nothing of how few directions all points share.
TEST(EncodeWithin, FindsTheRankOfSignalsOfManyCoefficients) {
  constexpr std::size_t kCount = 700, kMany = 320, kRank = 4;
  const auto weights = random_values(kCount * kRank, 31), axes = random_values(kRank * kMany, 32);
  std::vector<float> signal(kCount * kMany);
  for (std::size_t p = 0; p < kCount; ++p) {
    for (std::size_t r = 0; r < kRank; ++r) {
      for (std::size_t i = 0; i < kMany; ++i) {
        signal[p * kMany + i] += weights[p * kRank + r] * axes[r * kMany + i];
      }
    }
  }
  for (const Method method : {Method::fixed, Method::iterative}) {
    for (const Norm norm : {Norm::rmse, Norm::maximum}) {
      const Bound bound{.max_error = 1e-3, .norm = norm, .max_bytes = {}};
      const Found found = encode_within(bound, method, signal, kMany, {});
      EXPECT_EQ(found.trials[found.kept].choice, (Choice{1, kRank}));
      EXPECT_LE(found.flops_cost(), 3.0);
    }
  }
}

}  // namespace
}  // namespace prt::cpca
