#include "sh/hemisphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "linalg/decompose.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace prt::sh {
namespace {

using Kind = HemisphereProjection;

std::vector<SphereNode> hemisphere_quadrature(int degree) {
  const GaussLegendre rule(degree + 2);
  std::vector<SphereNode> nodes;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = (rule.nodes[k] + 1) / 2, r = std::sqrt(1 - z * z);
    for (int j = 0; j <= degree; ++j) {
      const double phi = 2 * std::numbers::pi * (j + 0.3) / (degree + 1);
      nodes.push_back({r * std::cos(phi), r * std::sin(phi), z,
                       rule.weights[k] * std::numbers::pi / (degree + 1)});
    }
  }
  return nodes;
}

std::vector<double> eigenvalues(int function_count) {
  const std::vector<int> functions = hemisphere_functions(function_count);
  std::vector<double> gram = hemisphere_gram(functions, functions);
  return linalg::largest_eigenpairs(
             linalg::MatrixD(gram.data(), functions.size(), functions.size()), functions.size())
      .values;
}

std::vector<double> multiply(const std::vector<double>& matrix, const std::vector<double>& vector) {
  std::vector<double> result(matrix.size() / vector.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t j = 0; j < vector.size(); ++j) {
      result[i] += matrix[i * vector.size() + j] * vector[j];
    }
  }
  return result;
}

TEST(ShHemisphere, FunctionsAreAllOfTheBandsOrAllButTheLinearOne) {
  EXPECT_EQ(hemisphere_functions(4), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(hemisphere_functions(8), (std::vector<int>{0, 1, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(hemisphere_functions(1).size(), 1u);
  EXPECT_EQ(hemisphere_functions(24).size(), 24u);
  EXPECT_EQ(hemisphere_functions(256).size(), 256u);
  EXPECT_EQ(band_count_of(hemisphere_functions(24)), 5);
  EXPECT_EQ(band_count_of(hemisphere_functions(25)), 5);
  EXPECT_EQ(band_count_of({}), 0);
  for (int count : {-1, 0, 2, 5, 23, 26, 255 + 2, 289}) {
    EXPECT_THROW(hemisphere_functions(count), Error) << count;
  }
}

TEST(ShHemisphere, GramIsTheIntegralOverTheHemisphere) {
  for (int band_count : {1, 2, 5, 8, 16}) {
    const int count = coefficient_count(band_count);
    const std::vector<int> functions = hemisphere_functions(count);
    const auto size = functions.size();
    std::vector<double> expected(size * size), values(size);
    for (const SphereNode& node : hemisphere_quadrature(2 * (band_count - 1))) {
      evaluate(band_count, node.x, node.y, node.z, values);
      for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) {
          expected[i * size + j] += node.weight * values[i] * values[j];
        }
      }
    }
    const std::vector<double> gram = hemisphere_gram(functions, functions);
    for (std::size_t i = 0; i < gram.size(); ++i) ASSERT_NEAR(gram[i], expected[i], 1e-13) << i;
  }
}

// Products of equal parity in z are even: half their integral over the sphere.
TEST(ShHemisphere, GramHasClosedForms) {
  const std::vector<int> functions = hemisphere_functions(25);
  const std::vector<double> gram = hemisphere_gram(functions, functions);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(gram[i * 25 + i], 0.5, 1e-15);
  EXPECT_NEAR(gram[2], std::sqrt(3.0) / 4, 1e-15);             // (0,0), (1,0)
  EXPECT_NEAR(gram[2 * 25 + 6], std::sqrt(15.0) / 16, 1e-15);  // (1,0), (2,0)
  EXPECT_EQ(gram[1], 0);
}

TEST(ShHemisphere, SingularValuesAreThePublishedOnes) {
  const std::vector<double> values = eigenvalues(25);
  EXPECT_NEAR(values[24], 6.59e-6, 0.005e-6);
  EXPECT_NEAR(values[23], 3.10e-4, 0.005e-4);
  EXPECT_NEAR(values[0], 1, 5e-3);
}

TEST(ShHemisphere, DroppingTheLinearFunctionCostsLeast) {
  const std::vector<int> functions = hemisphere_functions(25);
  EXPECT_NEAR(dropping_error(functions, 2), 1.48e-5, 0.005e-5);
  for (int function : functions) {
    if (function == 2) continue;
    EXPECT_GT(dropping_error(functions, function), 1.48e-5) << function;
  }
  // What is lost of f = y(1,0) when 24 functions stand for it, measured by the other path.
  EXPECT_NEAR(hemisphere_error(Kind::least_squares, hemisphere_functions(24), 5).worst, 1.48e-5,
              0.005e-5);
}

TEST(ShHemisphere, ErrorsAreThePublishedOnes) {
  const auto error = [](Kind kind, int band_count) {
    return hemisphere_error(kind, hemisphere_functions(band_count * band_count), 5);
  };
  const HemisphereError zero = error(Kind::zero_hemisphere, 5);
  EXPECT_NEAR(zero.worst, 0.125, 0.0005);
  EXPECT_NEAR(zero.mean, 0.0402, 0.00005);
  EXPECT_NEAR(std::sqrt(zero.worst), 0.35, 0.005);
  EXPECT_NEAR(std::sqrt(zero.mean), 0.20, 0.005);
  const HemisphereError odd = error(Kind::odd_reflection, 8);
  EXPECT_NEAR(odd.worst, 0.145, 0.0005);
  EXPECT_NEAR(odd.mean, 0.044, 0.0005);
  const HemisphereError even7 = error(Kind::even_reflection, 7);
  EXPECT_NEAR(even7.worst, 0.022, 0.0005);
  EXPECT_NEAR(even7.mean, 0.0036, 0.00005);
  const HemisphereError even5 = error(Kind::even_reflection, 5);
  EXPECT_NEAR(even5.worst, 0.193, 0.0005);
  EXPECT_NEAR(even5.mean, 0.030, 0.0005);
  EXPECT_NEAR(error(Kind::least_squares, 5).worst, 0, 1e-9);
}

TEST(ShHemisphere, ReflectionsKeepThePublishedNumberOfFunctions) {
  const auto kept = [](Kind kind, int band_count) {
    const auto functions = hemisphere_functions(band_count * band_count);
    const auto projection = hemisphere_projection(kind, functions);
    return std::count(projection.begin(), projection.end(), 2.0);
  };
  EXPECT_EQ(kept(Kind::odd_reflection, 8), 28);
  EXPECT_EQ(kept(Kind::even_reflection, 7), 28);
  EXPECT_EQ(kept(Kind::even_reflection, 5), 15);
}

TEST(ShHemisphere, ReflectionsAreProjectionsOfTheReflectedFunction) {
  const auto f = [](double x, double y, double z) { return 1 + x - 2 * y * z + z * z * z + x * z; };
  const std::vector<int> functions = hemisphere_functions(36);
  std::vector<double> moments(36), zero(36), odd(36), even(36), values(36);
  for (const SphereNode& node : hemisphere_quadrature(10)) {
    evaluate(6, node.x, node.y, node.z, values);
    for (std::size_t i = 0; i < 36; ++i) {
      const double part = node.weight * f(node.x, node.y, node.z) * values[i];
      moments[i] += part;
      zero[i] += part, odd[i] += part, even[i] += part;
    }
    evaluate(6, node.x, node.y, -node.z, values);
    for (std::size_t i = 0; i < 36; ++i) {
      const double part = node.weight * f(node.x, node.y, node.z) * values[i];
      odd[i] -= part, even[i] += part;
    }
  }
  const auto expect = [&](Kind kind, const std::vector<double>& expected) {
    const auto result = multiply(hemisphere_projection(kind, functions), moments);
    for (std::size_t i = 0; i < 36; ++i) EXPECT_NEAR(result[i], expected[i], 1e-12) << i;
  };
  expect(Kind::zero_hemisphere, zero);
  expect(Kind::odd_reflection, odd);
  expect(Kind::even_reflection, even);
}

TEST(ShHemisphere, LeastSquaresGivesBackBandLimitedFunctions) {
  Pcg32 random(31);
  const std::vector<int> functions = hemisphere_functions(25);
  const auto gram = hemisphere_gram(functions, functions);
  const auto projection = hemisphere_projection(Kind::least_squares, functions);
  std::vector<double> coefficients(25);
  for (double& c : coefficients) c = double{2 * random.uniform() - 1};
  const auto result = multiply(projection, multiply(gram, coefficients));
  for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(result[i], coefficients[i], 1e-9) << i;
}

// No other coefficients come closer: the residual is orthogonal to every function that takes part.
TEST(ShHemisphere, LeastSquaresResidualIsOrthogonal) {
  const auto f = [](double x, double y, double z) { return std::exp(3 * x - y) + std::sqrt(z); };
  for (int count : {16, 24, 25}) {
    const std::vector<int> functions = hemisphere_functions(count);
    const auto nodes = hemisphere_quadrature(40);
    const auto moments_of = [&](const auto& g) {
      std::vector<double> moments(functions.size()), values(25);
      for (const SphereNode& node : nodes) {
        evaluate(5, node.x, node.y, node.z, values);
        const double value = node.weight * g(node, values);
        for (std::size_t i = 0; i < moments.size(); ++i) {
          moments[i] += value * values[static_cast<std::size_t>(functions[i])];
        }
      }
      return moments;
    };
    const auto moments =
        moments_of([&](const SphereNode& n, const auto&) { return f(n.x, n.y, n.z); });
    const auto c = multiply(hemisphere_projection(Kind::least_squares, functions), moments);
    const auto residual = moments_of([&](const SphereNode& n, const std::vector<double>& values) {
      double value = f(n.x, n.y, n.z);
      for (std::size_t i = 0; i < c.size(); ++i) {
        value -= c[i] * values[static_cast<std::size_t>(functions[i])];
      }
      return value;
    });
    for (const double r : residual) EXPECT_NEAR(r, 0, 1e-8) << count;
  }
}

// With 16 bands A is singular in double precision (eigenvalues below 1e-20); P must stay bounded
// and still be a projection of what it keeps: P A P = P.
TEST(ShHemisphere, InversionIsBoundedNearSingularity) {
  const auto count = row_size(16);
  const std::vector<int> functions = hemisphere_functions(256);
  EXPECT_LT(eigenvalues(256).back(), 1e-15);
  std::vector<double> p = hemisphere_projection(Kind::least_squares, functions);
  const auto gram = hemisphere_gram(functions, functions);
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> c(count * count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        if (a[i * count + k] == 0) continue;
        for (std::size_t j = 0; j < count; ++j)
          c[i * count + j] += a[i * count + k] * b[k * count + j];
      }
    }
    return c;
  };
  const auto again = product(product(p, gram), p);
  for (std::size_t i = 0; i < p.size(); ++i) ASSERT_NEAR(again[i], p[i], 1e-3);
  const double largest =
      linalg::largest_eigenpairs(linalg::MatrixD(p.data(), count, count), 1).values[0];
  EXPECT_LE(largest, 1 / kMinimumEigenvalue * (1 + 1e-9));
  EXPECT_GT(largest, 1e3);
}

TEST(ShHemisphere, ProjectionKeepsOrdersApart) {
  for (int count : {24, 64}) {
    const std::vector<int> functions = hemisphere_functions(count);
    const auto p = hemisphere_projection(Kind::least_squares, functions);
    std::size_t zero_count = 0;
    for (double value : p) zero_count += value == 0;
    std::size_t same_order = 0;
    const auto order = [](int i) {
      const int l = static_cast<int>(std::sqrt(i));
      return i - coefficient_index(l, 0);
    };
    for (int a : functions) {
      for (int b : functions) same_order += order(a) == order(b);
    }
    EXPECT_EQ(zero_count + same_order, p.size());
  }
}

}  // namespace
}  // namespace prt::sh
