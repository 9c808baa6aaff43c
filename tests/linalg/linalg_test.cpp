#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "linalg/decompose.h"
#include "linalg/product.h"

namespace prt::linalg {
namespace {

template <class T>
std::vector<T> random_values(std::size_t count, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<T> values(count);
  for (T& value : values) value = random.uniform() - 0.5f;
  return values;
}

template <class T>
class Product : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Product, Precisions);

TYPED_TEST(Product, AgreesWithTheDefinitionInEveryOrientation) {
  using T = TypeParam;
  constexpr std::size_t m = 7, n = 5, k = 11, stride = 13;
  const auto a = random_values<T>(stride * stride, 1), b = random_values<T>(stride * stride, 2);
  for (Transpose ta : {Transpose::no, Transpose::yes}) {
    for (Transpose tb : {Transpose::no, Transpose::yes}) {
      const bool fa = ta == Transpose::yes, fb = tb == Transpose::yes;
      auto c = random_values<T>(m * stride, 3);
      const auto before = c;
      gemm(T(2), {a.data(), fa ? k : m, fa ? m : k, stride}, ta,
           {b.data(), fb ? n : k, fb ? k : n, stride}, tb, T(3), {c.data(), m, n, stride});
      for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < stride; ++j) {
          double sum = 0.0;
          for (std::size_t l = 0; l < k; ++l) {
            sum += double{a[fa ? l * stride + i : i * stride + l]} *
                   double{b[fb ? j * stride + l : l * stride + j]};
          }
          const double old = before[i * stride + j];
          const double expected = j < n ? 2.0 * sum + 3.0 * old : old;  // untouched past the row
          EXPECT_NEAR(c[i * stride + j], expected, 1e-5) << fa << fb << i << j;
        }
      }
    }
  }
}

TYPED_TEST(Product, DoesNotReadWhatZeroScales) {
  using T = TypeParam;
  const std::vector<T> a{1, 2}, b{3, 4};
  T c = std::numeric_limits<T>::quiet_NaN();
  gemm(T(1), {a.data(), 1, 2}, Transpose::no, {b.data(), 2, 1}, Transpose::no, T(0), {&c, 1, 1});
  EXPECT_EQ(c, T(11));
}

TEST(Blas, SaysWhichItIs) { EXPECT_NE(blas_description().find("BL"), std::string::npos); }

TEST(Blas, SplitIntoRowsOnManyThreadsGivesTheSameBytes) {
  constexpr std::size_t m = 1000, n = 37, k = 129;
  const auto a = random_values<float>(m * k, 4), b = random_values<float>(k * n, 5);
  const auto product = [&](int threads) {
    set_thread_count(threads);
    std::vector<float> c(m * n);
    parallel_for(m, 64, [&](std::size_t begin, std::size_t end) {
      gemm(1.0f, {&a[begin * k], end - begin, k}, Transpose::no, {b.data(), k, n}, Transpose::no,
           0.0f, {&c[begin * n], end - begin, n});
    });
    set_thread_count(0);
    return c;
  };
  EXPECT_EQ(product(1), product(4));
}

TEST(Eigenpairs, AreTheLargestInOrder) {
  constexpr std::size_t n = 40, count = 6;
  const double tolerance = 1e-13;
  const auto factor = random_values<double>(n * n, 6);
  std::vector<double> matrix(n * n);
  gemm(1.0, {factor.data(), n, n}, Transpose::yes, {factor.data(), n, n}, Transpose::no, 0.0,
       {matrix.data(), n, n});
  const auto untouched = matrix;
  const Eigenpairs pairs = largest_eigenpairs({matrix.data(), n, n}, count);
  ASSERT_EQ(pairs.values.size(), count);
  ASSERT_EQ(pairs.vectors.size(), count * n);
  for (std::size_t p = 0; p < count; ++p) {
    EXPECT_GE(pairs.values[p == 0 ? 0 : p - 1], pairs.values[p]);
    for (std::size_t i = 0; i < n; ++i) {
      double product = 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        product += untouched[i * n + j] * pairs.vectors[p * n + j];
      }
      EXPECT_NEAR(product, pairs.values[p] * pairs.vectors[p * n + i], tolerance);
    }
    for (std::size_t q = 0; q <= p; ++q) {
      double dot = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        dot += pairs.vectors[p * n + i] * pairs.vectors[q * n + i];
      }
      EXPECT_NEAR(dot, p == q ? 1.0 : 0.0, tolerance);
    }
  }
  // None is larger: the trace bounds the rest.
  const Eigenpairs all = [&] {
    auto copy = untouched;
    return largest_eigenpairs(MatrixD{copy.data(), n, n}, n);
  }();
  for (std::size_t p = 0; p < count; ++p) EXPECT_NEAR(all.values[p], pairs.values[p], tolerance);
}

TEST(Eigenpairs, OfADiagonalMatrixIsItsDiagonal) {
  std::vector<double> matrix{1, 0, 0, 0, 5, 0, 0, 0, 3};
  const auto pairs = largest_eigenpairs(MatrixD{matrix.data(), 3, 3}, 2);
  EXPECT_NEAR(pairs.values[0], 5.0, 1e-14);
  EXPECT_NEAR(pairs.values[1], 3.0, 1e-14);
  EXPECT_NEAR(std::abs(pairs.vectors[1]), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(pairs.vectors[5]), 1.0, 1e-14);
}

TEST(Eigenpairs, OfNothingIsNothing) {
  std::vector<double> matrix{1};
  EXPECT_TRUE(largest_eigenpairs(MatrixD{matrix.data(), 1, 1}, 0).values.empty());
}

TEST(Svd, FactorsMultiplyBackTallAndWide) {
  for (const auto& [m, n] : {std::pair<std::size_t, std::size_t>{9, 4}, {4, 9}}) {
    const auto a = random_values<double>(m * n, 8);
    const Svd factors = svd({a.data(), m, n});
    const std::size_t rank = std::min(m, n);
    ASSERT_EQ(factors.values.size(), rank);
    ASSERT_EQ(factors.u.size(), m * rank);
    ASSERT_EQ(factors.vt.size(), rank * n);
    EXPECT_TRUE(std::is_sorted(factors.values.rbegin(), factors.values.rend()));
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0.0;
        for (std::size_t r = 0; r < rank; ++r) {
          sum += factors.u[i * rank + r] * factors.values[r] * factors.vt[r * n + j];
        }
        EXPECT_NEAR(sum, a[i * n + j], 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace prt::linalg
