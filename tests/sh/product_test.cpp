#include "sh/product.h"

#include <gtest/gtest.h>

#include "sh/basis.h"
#include "sh/directions.h"

namespace prt::sh {
namespace {

TEST(ShProduct, IsTheProjectionOfTheProduct) {
  Pcg32 random(21);
  for (int band_count : {1, 2, 5, 8}) {
    const auto count = row_size(band_count);
    const std::vector<float> a = random_coefficients(count, random);
    const std::vector<float> b = random_coefficients(count, random);
    std::vector<double> expected(count), values(count);
    for (const SphereNode& node : sphere_quadrature(3 * (band_count - 1))) {
      evaluate(band_count, node.x, node.y, node.z, values);
      double a_value = 0, b_value = 0;
      for (std::size_t i = 0; i < count; ++i) {
        a_value += values[i] * double{a[i]};
        b_value += values[i] * double{b[i]};
      }
      for (std::size_t i = 0; i < count; ++i) {
        expected[i] += node.weight * a_value * b_value * values[i];
      }
    }
    std::vector<float> product(count);
    ProductTable(band_count).multiply(a, b, product);
    for (std::size_t i = 0; i < count; ++i) ASSERT_NEAR(product[i], expected[i], 1e-5) << i;
  }
}

TEST(ShProduct, MatrixIsSymmetricAndMultiplies) {
  Pcg32 random(22);
  const std::size_t count = 25;
  const ProductTable table(5);
  const std::vector<float> a = random_coefficients(count, random);
  const std::vector<float> b = random_coefficients(count, random);
  std::vector<float> product(count), matrix(count * count);
  table.multiply(a, b, product);
  table.matrix(a, matrix);
  for (std::size_t k = 0; k < count; ++k) {
    float sum = 0;
    for (std::size_t j = 0; j < count; ++j) {
      ASSERT_NEAR(matrix[k * count + j], matrix[j * count + k], 1e-6f);
      sum += matrix[k * count + j] * b[j];
    }
    ASSERT_NEAR(sum, product[k], 1e-5f);
  }
}

TEST(ShProduct, ConstantOneIsNeutral) {
  Pcg32 random(23);
  const std::size_t count = 100;
  std::vector<float> one(count), product(count);
  one[0] = std::sqrt(4 * std::numbers::pi_v<float>);
  const std::vector<float> a = random_coefficients(count, random);
  ProductTable(10).multiply(one, a, product);
  for (std::size_t i = 0; i < count; ++i) ASSERT_NEAR(product[i], a[i], 1e-6f);
}

TEST(ShProduct, TableIsSparse) {
  EXPECT_EQ(ProductTable(1).entry_count(), 1u);
  // All of C(i,j,k) with a constant among them: 1 + 3 · 3 of the 4³ of two bands.
  EXPECT_EQ(ProductTable(2).entry_count(), 10u);
  EXPECT_LT(ProductTable(5).entry_count(), 25u * 25u * 25u / 10u);
}

}  // namespace
}  // namespace prt::sh
