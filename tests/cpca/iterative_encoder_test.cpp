// Iterative CPCA against the plain method, and what [Sloan03] §4.2 promises of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/fit.h"
#include "cpca/iterative_encoder.h"
#include "cpca/plain_iterative.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

/// Errors are what is left of squares in single precision.
constexpr double kRounding = 1e-5;

struct Case {
  std::size_t point_count, dimension, group_count;
  Options options;
};

// Fewer coefficients than are worth axes of their own, twice; few enough dimensions for half as
// many axes.
const Case kCases[] = {
    {2000, 25, 6, {.cluster_count = 6, .component_count = 4, .iterations = 15}},
    {1000, 80, 12, {.cluster_count = 12, .component_count = 3, .iterations = 15}},
    {1200, 128, 4, {.cluster_count = 6, .component_count = 6, .iterations = 15}},
};

// So many that between full passes only near ones are tried. The second has too many dimensions for
// half as many axes.
const Case kManyClusters[] = {
    {3000, 25, 12, {.cluster_count = 60, .component_count = 4, .iterations = 15}},
    {2000, 140, 20, {.cluster_count = 50, .component_count = 3, .iterations = 15}},
    {2000, 128, 4, {.cluster_count = 40, .component_count = 3, .iterations = 15}},
};

TEST(IterativeEncoder, ErrorNeverRises) {
  for (const Case& test : kManyClusters) {
    const auto signal = make_signal(test.point_count, test.dimension, test.group_count);
    const Encoded encoded =
        encode_iterative(signal, static_cast<int>(test.dimension), test.options);
    ASSERT_EQ(encoded.levels.size(), test.options.component_count + 1u);
    double last = std::numeric_limits<double>::infinity();
    int iterations = 0;
    for (const Level& level : encoded.levels) {
      ASSERT_FALSE(level.errors.empty());
      EXPECT_LE(level.errors.size(), static_cast<std::size_t>(test.options.iterations));
      for (double error : level.errors) {
        EXPECT_LE(error, last * (1.0 + kRounding)) << level.component_count << " vectors";
        last = error;
        ++iterations;
      }
    }
    EXPECT_EQ(encoded.iterations, iterations);
    EXPECT_GT(iterations, 3 * (test.options.component_count + 1));
    EXPECT_LE(error_of(encoded, signal), last * (1.0 + kRounding));
  }
}

// Where loose passes let it rise, of groups and of noise, and leave clusters empty.
TEST(IterativeEncoder, ErrorNeverRisesInClustersOfFewPoints) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const bool is_noise = seed % 2 == 0;
    const auto signal = is_noise ? random_values(600 * 40, seed) : make_signal(360, 10, 12, seed);
    const Options options{.cluster_count = is_noise ? 20 : 70,
                          .component_count = is_noise ? 1 : 3,
                          .iterations = 15,
                          .seed = seed};
    const Encoded encoded = encode_iterative(signal, is_noise ? 40 : 10, options);
    double last = std::numeric_limits<double>::infinity();
    for (const Level& level : encoded.levels) {
      for (double error : level.errors) {
        EXPECT_LE(error, last * (1.0 + kRounding)) << level.component_count << " vectors";
        last = error;
      }
    }
  }
}

// Without noise, so that errors end near 10⁻⁸ of the squares that they are differences of.
TEST(IterativeEncoder, SmallErrorsNeverRiseAndAreTrue) {
  const Case cases[] = {
      {3600, 30, 0, {.cluster_count = 20, .component_count = 18, .iterations = 10}},
      {2500, 128, 0, {.cluster_count = 16, .component_count = 20, .iterations = 10}},
  };
  for (const Case& test : cases) {
    const auto side = static_cast<std::size_t>(std::sqrt(test.point_count));
    const auto signal = make_smooth_signal(side, test.dimension, 24.0f);
    const Encoded encoded =
        encode_iterative(signal, static_cast<int>(test.dimension), test.options);
    const auto whole = summarize(point_errors(encoded.encoding, signal), signal);
    EXPECT_LT(whole.relative_rmse(), 2e-4);
    for (const Level& level : encoded.levels) {
      double last = std::numeric_limits<double>::infinity();
      for (double error : level.errors) {
        EXPECT_LE(error, last * (1.0 + kRounding)) << level.component_count << " vectors";
        last = error;
      }
    }
    EXPECT_NEAR(encoded.levels.back().errors.back(), whole.squared_error,
                0.01 * whole.squared_error);
  }
}

TEST(IterativeEncoder, IsAsGoodAsThePlainMethod) {
  for (const Case& test : kCases) {
    const auto signal = make_signal(test.point_count, test.dimension, test.group_count);
    const Encoded encoded =
        encode_iterative(signal, static_cast<int>(test.dimension), test.options);
    PlainIterative plain(signal, test.dimension,
                         static_cast<std::size_t>(test.options.cluster_count), test.options.seed);
    const double expected = plain.run(test.options.component_count, test.options.iterations);
    EXPECT_NEAR(error_of(encoded, signal), expected, 0.005 * expected);
  }
}

// More clusters than are tried between full passes. Which local minimum either finds is chance, so
// that it takes the mean over signals and seeds to compare.
TEST(IterativeEncoder, IsAsGoodAsThePlainMethodWithManyClusters) {
  const std::pair<std::size_t, std::vector<float>> signals[] = {
      {16, make_signal(1200, 16, 24)},
      {24, make_smooth_signal(35, 24, 20.0f)},
      {40, make_uneven_signal(1200, 40, 6)},
  };
  double sum = 0.0, strict_sum = 0.0;
  int count = 0;
  for (const auto& [n, signal] : signals) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Options options{
          .cluster_count = 64, .component_count = 2, .iterations = 12, .seed = seed};
      const double error = error_of(encode_iterative(signal, static_cast<int>(n), options), signal),
                   ratio = error / PlainIterative(signal, n, 64, seed).run(2, 12, true);
      EXPECT_NEAR(ratio, 1.0, 0.03) << n << " coefficients, seed " << seed;
      sum += ratio;
      strict_sum += error / PlainIterative(signal, n, 64, seed).run(2, 12);
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 1.0, 0.005);
  EXPECT_LT(strict_sum / count, 0.95);  // which is what loose passes are for
}

TEST(IterativeEncoder, MeasuresLevelsInAllCoordinates) {
  constexpr int kDimension = 128;
  const auto signal = make_signal(1200, kDimension, 4);
  const Options options{.cluster_count = 20, .component_count = 3, .iterations = 4};
  IterativeEncoder encoder(signal, kDimension, options);
  const auto error_of_best = [&](const std::vector<std::uint32_t>& labels, int count) {
    Options here = options;
    here.component_count = count;
    Encoded best;
    best.encoding = fit(signal, kDimension, labels, here);
    return error_of(best, signal);
  };
  double last = std::numeric_limits<double>::infinity();
  for (int count = 0; count <= 3; ++count) {
    const double in_axes = encoder.run_level().errors.back();
    EXPECT_LE(in_axes, last * (1.0 + kRounding));  // the one before does not suffer from it
    last = in_axes;
    const double before = error_of_best(encoder.clusterer().labels(), count);
    const double measured = encoder.measure();
    EXPECT_LT(measured, in_axes);
    EXPECT_LT(measured, 1.01 * before);  // points move once more
    EXPECT_GT(measured, (1.0 - kRounding) * error_of_best(encoder.clusterer().labels(), count));
    double sum = 0.0;
    for (const float error : encoder.clusterer().errors()) sum += double{error};
    EXPECT_NEAR(sum, measured, 1e-6 * measured);
  }
}

TEST(IterativeEncoder, IsBetterThanStatic) {
  for (const Case& test : kManyClusters) {
    const auto signal = make_signal(test.point_count, test.dimension, test.group_count);
    const auto n = static_cast<int>(test.dimension);
    EXPECT_LT(error_of(encode_iterative(signal, n, test.options), signal),
              0.9 * error_of(encode_static(signal, n, test.options), signal));
  }
}

TEST(IterativeEncoder, SameBytesForAnyThreadCountAndTwice) {
  const auto signal = make_signal(6000, 128, 5);
  for (int clusters : {1, 50}) {
    const auto encode = [&](int threads) {
      set_thread_count(threads);
      return encode_iterative(signal, 128,
                              {.cluster_count = clusters, .component_count = 3, .iterations = 4});
    };
    const Encoded one = encode(1);
    for (int threads : {2, 4, 2}) {
      const Encoded other = encode(threads);
      EXPECT_EQ(one.encoding.means, other.encoding.means);
      EXPECT_EQ(one.encoding.bases, other.encoding.bases);
      EXPECT_EQ(one.encoding.cluster_of_point, other.encoding.cluster_of_point);
      EXPECT_EQ(one.encoding.weights, other.encoding.weights);
    }
    set_thread_count(0);
  }
}

TEST(IterativeEncoder, DegenerateSignalsAreExact) {
  for (const DegenerateCase& test : degenerate_cases()) {
    const Encoded encoded = encode_iterative(test.signal, 9, test.options);
    EXPECT_LT(summarize(point_errors(encoded.encoding, test.signal), test.signal).relative_rmse(),
              1e-6)
        << test.name;
    for (float value : encoded.encoding.weights) EXPECT_TRUE(std::isfinite(value)) << test.name;
    for (float value : encoded.encoding.means) EXPECT_TRUE(std::isfinite(value)) << test.name;
  }
}

TEST(IterativeEncoder, RefusesWhatStaticDoes) {
  auto signal = random_values(40, 1);  // 10 × 4
  EXPECT_THROW(encode_iterative(signal, 4, {.cluster_count = 11, .component_count = 1}), Error);
  EXPECT_THROW(encode_iterative(signal, 4, {.cluster_count = 2, .component_count = 5}), Error);
  signal[30] = std::nanf("");
  EXPECT_THROW(encode_iterative(signal, 4, {.cluster_count = 2, .component_count = 1}), Error);
  signal[30] = -1e16f;  // its square is near the end of the range
  EXPECT_THROW(encode_iterative(signal, 4, {.cluster_count = 2, .component_count = 1}), Error);
}

}  // namespace
}  // namespace prt::cpca
