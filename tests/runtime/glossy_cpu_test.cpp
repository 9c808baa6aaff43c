// The parts of glossy drawing that need no OpenGL.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "runtime/cluster_constants.h"
#include "runtime/exit_stage.h"
#include "runtime/glossy_models.h"
#include "runtime/hemisphere_map.h"
#include "runtime/shading.h"
#include "runtime/view_basis.h"
#include "sh/hemisphere.h"

namespace prt::runtime {
namespace {

TEST(ExitLayout, PairsFunctionsOfOppositeOrders) {
  for (const int row_count : {3, 4, 8, 9, 15, 16, 24, 25, 36, 255, 256}) {
    const ExitLayout layout = exit_layout(row_count, 1);
    ASSERT_EQ(layout.row_of_slot.size(), static_cast<std::size_t>(row_count));
    EXPECT_EQ(std::set<int>(layout.row_of_slot.begin(), layout.row_of_slot.end()).size(),
              layout.row_of_slot.size());
    EXPECT_EQ(layout.color_vector_count(), (static_cast<std::size_t>(row_count) + 3) / 4);
    EXPECT_EQ(layout.order_of_pair.size(), 2 * layout.color_vector_count());
    const auto function = [&](std::size_t slot) {
      return layout.functions[static_cast<std::size_t>(layout.row_of_slot[slot])];
    };
    for (std::size_t slot = 0; slot < layout.row_of_slot.size(); ++slot) {
      const int m = layout.order_of_pair[slot / 2];
      const int l = static_cast<int>(std::sqrt(function(slot) + 0.5));
      EXPECT_EQ(function(slot), sh::coefficient_index(l, slot % 2 == 0 ? m : -m));
    }
  }
}

TEST(ExitLayout, ColoursShareOnePassOrHaveEachTheirOwn) {
  EXPECT_EQ(exit_layout(1, 3).pass_count, 1);
  EXPECT_EQ(exit_layout(1, 1).pass_vector_count(), 1u);
  EXPECT_EQ(exit_layout(25, 1).pass_vector_count(), 21u);
  EXPECT_EQ(exit_layout(24, 1).pass_vector_count(), 18u);
  EXPECT_EQ(exit_layout(24, 3).pass_vector_count(), 6u);
}

TEST(Passes, AreAsFewAsTheContextCan) {
  gl::Limits limits{};
  limits.max_varying_vectors = 32;
  limits.max_vertex_uniform_vectors = 1024;
  const auto choose = [&](Passes passes, int rows = 25) {
    return choose_pass_count(passes, rows, 8, limits);
  };
  EXPECT_EQ(choose(Passes::automatic), 1);
  EXPECT_EQ(choose(Passes::one), 1);
  EXPECT_EQ(choose(Passes::per_channel), 3);
  EXPECT_EQ(choose(Passes::per_channel, 1), 1);
  limits.max_varying_vectors = 21;  // one short: the view is a varying too
  EXPECT_EQ(choose(Passes::automatic), 3);
  EXPECT_EQ(choose(Passes::automatic, 24), 1);
  EXPECT_THROW(choose(Passes::one), Error);
  limits.max_varying_vectors = 32;
  limits.max_vertex_uniform_vectors = 150;  // nine constants of 21 vec4 do not fit
  EXPECT_EQ(choose(Passes::automatic), 3);
  limits.max_varying_vectors = 7;
  EXPECT_THROW(choose(Passes::automatic), Error);
}

TEST(ClusterConstants, OfGlossyTransferAreMatricesTimesLight) {
  for (const int channel_count : {1, 3})
    for (const int pass_count : {1, 3}) {
      const auto transfer = random_transfer(10, 4, channel_count, 50, 3, 8);
      const ExitLayout layout = exit_layout(8, pass_count);
      const sh::Light light = test_light(4);
      ClusterConstants constants(transfer, layout);
      const std::vector<Vec4>& found = constants.evaluate(light);
      ASSERT_EQ(found.size(), 50u * 4u * 3u * 2u);
      for (std::size_t constant = 0; constant < 200; ++constant)
        for (std::size_t color = 0; color < 3; ++color)
          for (std::size_t slot = 0; slot < 8; ++slot) {
            const auto cluster = static_cast<int>(constant / 4), i = static_cast<int>(constant % 4);
            const std::span<const float> x =
                i == 0 ? transfer.encoding.mean(cluster) : transfer.encoding.basis(cluster, i - 1);
            const std::size_t row = static_cast<std::size_t>(layout.row_of_slot[slot]) +
                                    (channel_count == 3 ? 8 * color : 0);
            double sum = 0;
            for (std::size_t k = 0; k < 16; ++k)
              sum += double{x[row * 16 + k]} * light.coefficients[color][k];
            const std::size_t vector =
                pass_count == 1 ? constant * 6 + color * 2 : (color * 200 + constant) * 2;
            EXPECT_NEAR(found[vector + slot / 4][static_cast<int>(slot % 4)], sum, 1e-5);
          }
    }
}

/// The spline of one function at a direction; twin of hemisphere_map.glsl, all sixteen weights.
float spline_at(const std::vector<Vec4>& texels, std::size_t slot, const Vec3& direction) {
  const auto weights = [](float f) {
    const float g = 1 - f;
    return Vec4(g * g * g, 4 - 6 * f * f + 3 * f * f * f, 4 - 6 * g * g + 3 * g * g * g,
                f * f * f) /
           6.0f;
  };
  float corner[2], sum = 0;
  Vec4 weight[2];
  for (int i = 0; i < 2; ++i) {
    const float texel =
        1 + (0.5f + 0.5f * direction[i] / (1 + direction.z)) * (kHemisphereMapSize - 3);
    corner[i] = std::floor(texel);
    weight[i] = weights(texel - corner[i]);
  }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int x = std::min(static_cast<int>(corner[0]) + i - 1, kHemisphereMapSize - 1);
      const int y = std::min(static_cast<int>(corner[1]) + j - 1, kHemisphereMapSize - 1);
      const std::size_t layer = slot / 4 * kHemisphereMapSize * kHemisphereMapSize;
      sum += weight[0][i] * weight[1][j] *
             texels[layer + static_cast<std::size_t>(y * kHemisphereMapSize + x)]
                   [static_cast<int>(slot % 4)];
    }
  return sum;
}

TEST(HemisphereMap, GivesTheFunctionsOfFiveBandsToAThousandth) {
  const ExitLayout layout = exit_layout(25, 1);
  const std::vector<Vec4> texels = hemisphere_map(layout);
  ASSERT_EQ(texels.size(), 7u * kHemisphereMapSize * kHemisphereMapSize);
  std::vector<float> basis(25);
  float worst = 0;
  double square = 0;
  Pcg32 random(1);
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const float z = i < 100 ? 0.0f : random.uniform();  // the rim too
    const float phi = 2 * std::numbers::pi_v<float> * random.uniform();
    const float r = std::sqrt(1 - z * z);
    const Vec3 direction(r * std::cos(phi), r * std::sin(phi), z);
    sh::evaluate(5, direction, basis);
    for (std::size_t slot = 0; slot < 25; ++slot) {
      const auto row = static_cast<std::size_t>(layout.row_of_slot[slot]);
      const float error = spline_at(texels, slot, direction) - basis[row];
      worst = std::max(worst, std::abs(error));
      square += double{error} * error;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 1e-3f);
  EXPECT_LT(std::sqrt(square / (25 * kCount)), 1e-4);
}

TEST(ViewBasis, PolynomialsAreTheFunctions) {
  constexpr int kBandCount = 8;
  std::vector<double> basis(kBandCount * kBandCount);
  for (const double z : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const double x = std::sqrt(1 - z * z);  // y = 0: Re (x + iy)^m = x^m
    sh::evaluate(kBandCount, x, 0.0, z, basis);
    for (int l = 0; l < kBandCount; ++l)
      for (int m = 0; m <= l; ++m) {
        const std::vector<double> factors = polynomial_of_z(l, m);
        ASSERT_EQ(factors.size(), static_cast<std::size_t>(l - m) + 1);
        double sum = 0;
        for (std::size_t i = 0; i < factors.size(); ++i) sum += factors[i] * std::pow(z, i);
        const auto index = static_cast<std::size_t>(sh::coefficient_index(l, m));
        EXPECT_NEAR(sum * std::pow(x, m), basis[index], 1e-12) << l << " " << m;
      }
  }
}

TEST(ViewBasis, WritesFunctionsBySlotAndZerosBehindThem) {
  EXPECT_EQ(basis_polynomials(exit_layout(3, 1)),
            "F(0, vec4(-0.488602512 * p[1], 0.282094792, 0.0)) ");
  EXPECT_EQ(basis_polynomials(exit_layout(9, 1)),
            "F(0, vec4(-0.488602512 * p[1], z * -1.09254843 * p[1])) "
            "F(1, vec4(0.546274215 * p[2], 0.282094792, z * 0.488602512)) "
            "F(2, vec4((-0.315391565 + zz * 0.946174696), 0.0, 0.0, 0.0)) ");
}

TEST(Shading, ExitRadianceBelowTheHorizonIsThatOfTheRim) {
  std::vector<Vec3> values(24);
  Pcg32 random(3);
  for (Vec3& value : values) value = Vec3(random.uniform(), random.uniform(), random.uniform());
  EXPECT_EQ(exit_radiance(values, Vec3(0.6f, 0, -0.8f)), exit_radiance(values, Vec3(1, 0, 0)));
  EXPECT_NE(exit_radiance(values, Vec3(0.6f, 0, 0.8f)), exit_radiance(values, Vec3(1, 0, 0)));
}

}  // namespace
}  // namespace prt::runtime
