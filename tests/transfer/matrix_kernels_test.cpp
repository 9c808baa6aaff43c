#include "transfer/matrix_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "sh/hemisphere.h"
#include "transfer/matrix_field.h"

namespace prt::transfer {
namespace {

TEST(SmallProduct, IsThePlainSum) {
  Pcg32 random(1);
  for (const std::size_t rows : {1u, 3u, 4u, 25u, 66u}) {
    for (const std::size_t columns : {16u, 32u, 80u}) {
      const std::size_t depth = 7 + rows % 5, a_stride = rows + 2, b_stride = columns + 1;
      std::vector<float> a(depth * a_stride), b(depth * b_stride), c(rows * columns);
      for (auto* list : {&a, &b, &c}) {
        for (float& value : *list) value = 2 * random.uniform() - 1;
      }
      std::vector<float> expected = c;
      for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t j = 0; j < columns; ++j) {
          for (std::size_t k = 0; k < depth; ++k) {
            expected[i * columns + j] += a[k * a_stride + i] * b[k * b_stride + j];
          }
        }
      }
      add_product(
          {a.data(), a_stride, b.data(), b_stride, c.data(), columns, rows, depth, columns});
      for (std::size_t i = 0; i < c.size(); ++i) ASSERT_NEAR(c[i], expected[i], 1e-5);
    }
  }
}

TEST(HalfFloats, AreRoundedAndLimited) {
  std::vector<float> values{0, 1, -2.5f, 65504, 1e6f, -1e30f, 1e-9f};
  Pcg32 random(2);
  while (values.size() < 29) values.push_back(random.uniform());
  std::vector<std::uint16_t> halfs(values.size());
  std::vector<float> back(values.size());
  float_to_half(values.data(), halfs.data(), values.size());
  half_to_float(halfs.data(), back.data(), values.size());
  EXPECT_EQ(std::vector<float>(back.begin(), back.begin() + 7),
            (std::vector<float>{0, 1, -2.5f, 65504, 65504, -65504, 0}));
  for (std::size_t i = 7; i < values.size(); ++i) {
    EXPECT_NEAR(back[i], values[i], 0x1p-12f) << i;
  }
}

// ∫_H φ_f φ_g = 1 or 0, and both ways of the basis say the same function.
TEST(ExitBasis, IsOrthonormalOnTheHemisphere) {
  for (const int count : {1, 3, 4, 16, 24, 25, 64}) {
    const auto functions = sh::hemisphere_functions(count);
    const ExitBasis basis(functions);
    const std::size_t size = basis.function_count, n = basis.row_count;
    EXPECT_LE(size, n);
    EXPECT_GE(size, count < 30 ? n : n - 20);
    const auto gram = sh::hemisphere_gram(functions, functions);
    for (std::size_t f = 0; f < size; ++f) {
      for (std::size_t g = 0; g < size; ++g) {
        double product = 0, back = 0;
        for (std::size_t i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(functions[i]);
          back += double{basis.from_sh[i * size + f]} * double{basis.from_directions[k * size + g]};
          for (std::size_t j = 0; j < n; ++j) {
            const auto l = static_cast<std::size_t>(functions[j]);
            product += double{basis.from_directions[k * size + f]} * gram[i * n + j] *
                       double{basis.from_directions[l * size + g]};
          }
        }
        ASSERT_NEAR(product, f == g ? 1 : 0, 1e-4) << count << " " << f << " " << g;
        ASSERT_NEAR(back, f == g ? 1 : 0, 1e-4) << count << " " << f << " " << g;
      }
    }
  }
}

TEST(ExitField, KeepsRows) {
  ExitField field(std::filesystem::temp_directory_path(), 10, 3);
  EXPECT_EQ(field.byte_count(), 60u);
  const std::vector<std::uint16_t> written{1, 2, 3, 4, 5, 6};
  field.write(4, written);
  std::vector<std::uint16_t> read(6);
  field.read(4, read);
  EXPECT_EQ(read, written);
}

}  // namespace
}  // namespace prt::transfer
