#include "brdf/brdf_matrix.h"

#include <gtest/gtest.h>

#include "all_lobes.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::brdf {
namespace {

const std::filesystem::path kNoCache;

Brdf one(LobePointer lobe) { return {{{Colour(1), std::move(lobe)}}}; }

TEST(BrdfMatrix, SumsColouredLobes) {
  const Brdf brdf{{{{0.5, 0.25, 0}, ggx(0.5, 0.5)}, {{0, 0.25, 2}, lambert()}}};
  const auto a = compute_lobe_matrix(*ggx(0.5, 0.5), 3, 4, 1e-4);
  const auto b = compute_lobe_matrix(*lambert(), 3, 4, 1e-4);
  const BrdfMatrix sum = brdf_matrix(brdf, 3, 4, 1e-4, kNoCache);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    EXPECT_NEAR(sum.channels[0][i], 0.5 * a.values[i], 1e-12);
    EXPECT_NEAR(sum.channels[1][i], 0.25 * (a.values[i] + b.values[i]), 1e-12);
    EXPECT_NEAR(sum.channels[2][i], 2 * b.values[i], 1e-12);
  }
  EXPECT_NEAR(sum.error, 0.5 * a.error + 2 * b.error, 1e-12);
}

// A turned lobe, by Monte Carlo over uniform directions.
TEST(BrdfMatrix, RotationTurnsTheTangent) {
  Brdf brdf = one(ggx(0.9, 0.4));
  brdf.rotation = 0.6;
  constexpr int kCount = 300000;
  std::vector<double> sums(9 * 16), squares(9 * 16), rows(9), columns(16);
  Pcg32 random(11);
  for (int n = 0; n < kCount; ++n) {
    const Direction v = random_upper(random), s = random_upper(random);
    const double weight = 4 * std::pow(std::numbers::pi, 2) * s.z * evaluate(brdf, s, v).x;
    sh::evaluate(3, v.x, v.y, v.z, rows);
    sh::evaluate(4, s.x, s.y, s.z, columns);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double term = weight * rows[i / 16] * columns[i % 16];
      sums[i] += term, squares[i] += term * term;
    }
  }
  const auto turned = brdf_matrix(brdf, 3, 4, 1e-4, kNoCache).channels[0];
  brdf.rotation = 0;
  const auto straight = brdf_matrix(brdf, 3, 4, 1e-4, kNoCache).channels[0];
  double change = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double mean = sums[i] / kCount;
    const double deviation = std::sqrt((squares[i] / kCount - mean * mean) / kCount);
    EXPECT_NEAR(turned[i], mean, 5 * deviation + 1e-4) << i;
    change = std::max(change, std::abs(straight[i] - mean) / deviation);
  }
  EXPECT_GT(change, 20);  // otherwise this would not see a missing rotation
}

TEST(BrdfMatrix, SmoothMaterialsLoseNothing) {
  const BandLoss loss = brdf_matrix(one(lambert()), 3, 3, 1e-6, kNoCache).loss;
  EXPECT_NEAR(loss.exit, 0, 1e-5);
  EXPECT_NEAR(loss.kernel, 0, 1e-5);
}

TEST(BrdfMatrix, LossGrowsWithSharpnessAndShrinksWithBands) {
  const auto loss = [](LobePointer lobe, int rows, int columns) {
    return brdf_matrix(one(std::move(lobe)), rows, columns, 1e-4, kNoCache).loss;
  };
  const BandLoss soft = loss(phong(10), 5, 5), sharp = loss(phong(100), 5, 5);
  EXPECT_LT(soft.kernel, 0.05);
  EXPECT_GT(loss(phong(500), 5, 5).kernel, kSharpKernelLoss);
  EXPECT_LT(loss(phong(50), 5, 5).kernel, kSharpKernelLoss);
  EXPECT_LT(loss(phong(100), 8, 8).kernel, sharp.kernel);
  EXPECT_GT(loss(phong(10), 4, 5).exit, 10 * soft.exit);
  // A mirror shows all of band-limited light, and nearly nothing of all light.
  const BandLoss mirror = loss(ggx(kMinAlpha, kMinAlpha), 4, 4);
  EXPECT_LT(mirror.exit, 1e-3);
  EXPECT_GT(mirror.kernel, 0.999);
}

// The figure against its meaning: what of f s_z is left when the best approximation within the
// bands is taken away, at random pairs of directions.
TEST(BrdfMatrix, KernelLossIsTheResidual) {
  const auto lobe = phong(30);
  const LobeMatrix matrix = compute_lobe_matrix(*lobe, 4, 4, 1e-6);
  const BandLoss loss = brdf_matrix(one(lobe), 4, 4, 1e-6, kNoCache).loss;
  const auto functions = sh::hemisphere_functions(16);
  const auto p = sh::hemisphere_projection(sh::HemisphereProjection::least_squares, functions);
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> c(256);
    for (std::size_t i = 0; i < 256; ++i) {
      for (std::size_t k = 0; k < 16; ++k) c[i] += a[i / 16 * 16 + k] * b[k * 16 + i % 16];
    }
    return c;
  };
  const auto coefficients = product(product(p, matrix.values), p);
  Pcg32 random(12);
  double lost = 0, all = 0;
  std::vector<double> rows(16), columns(16);
  for (int n = 0; n < 200000; ++n) {
    const Direction v = random_upper(random), s = random_upper(random);
    const double kernel = lobe->evaluate(s, v) * s.z;
    sh::evaluate(4, v.x, v.y, v.z, rows);
    sh::evaluate(4, s.x, s.y, s.z, columns);
    double rest = kernel;
    for (std::size_t i = 0; i < 256; ++i) rest -= coefficients[i] * rows[i / 16] * columns[i % 16];
    lost += rest * rest, all += kernel * kernel;
  }
  EXPECT_NEAR(loss.kernel, lost / all, 0.01);
  EXPECT_GT(loss.kernel, 0.1);
}

TEST(BrdfMatrix, LossOfASumIsBoundedByItsParts) {
  const Brdf glossy = make_brdf({.metallic = 0, .roughness = 0.3});
  const double sum = brdf_matrix(glossy, 4, 4, 1e-3, kNoCache).loss.kernel;
  EXPECT_GT(sum, 0);
  EXPECT_LT(sum, brdf_matrix(one(ggx(0.09, 0.09)), 4, 4, 1e-3, kNoCache).loss.kernel);
}

}  // namespace
}  // namespace prt::brdf
