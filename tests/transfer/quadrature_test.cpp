#include <gtest/gtest.h>

#include "transfer/clamped_cosine.h"
#include "transfer/directions.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

TEST(Directions, IntegrateProductsOfTheBasis) {
  for (std::uint64_t seed : {1, 2, 77}) {
    const Directions directions = make_directions(4096, seed);
    ASSERT_EQ(directions.count(), 4096u);
    std::vector<double> gram(25 * 25);
    std::vector<float> y(25);
    for (std::size_t d = 0; d < directions.count(); ++d) {
      EXPECT_NEAR(directions[d].length(), 1.0f, 1e-6f);
      sh::evaluate(5, directions[d], y);
      for (std::size_t i = 0; i < 25; ++i) {
        for (std::size_t j = 0; j < 25; ++j) {
          gram[i * 25 + j] += double{y[i]} * y[j] * 4.0 * std::numbers::pi / 4096.0;
        }
      }
    }
    for (std::size_t i = 0; i < 25; ++i) {
      for (std::size_t j = 0; j < 25; ++j) {
        EXPECT_NEAR(gram[i * 25 + j], i == j ? 1.0 : 0.0, 2e-3);
      }
    }
  }
}

TEST(Directions, FollowFromTheSeedAndKeepNeighboursTogether) {
  const Directions a = make_directions(4096, 1), b = make_directions(4096, 1),
                   c = make_directions(4096, 2);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_NE(a.x, c.x);
  double step = 0.0;
  for (std::size_t d = 1; d < a.count(); ++d) step += (a[d] - a[d - 1]).length();
  const double spacing = std::sqrt(4.0 * std::numbers::pi / 4096.0);
  EXPECT_LT(step / 4096.0, 2.5 * spacing);
}

TEST(ClampedCosine, IsTheIntegralOverTheHemisphere) {
  const Directions directions = make_directions(200000, 3);
  const Vec3 normal = Vec3(0.3f, -0.8f, 0.5f).normalized();
  std::vector<float> lobe(81), y(81);
  clamped_cosine(9, normal, lobe);
  std::vector<double> sum(81);
  for (std::size_t d = 0; d < directions.count(); ++d) {
    const double cosine = normal.dot(directions[d]);
    if (cosine <= 0.0) continue;
    sh::evaluate(9, directions[d], y);
    for (std::size_t i = 0; i < 81; ++i) sum[i] += cosine * y[i] * 4.0 * std::numbers::pi / 2e5;
  }
  for (std::size_t i = 0; i < 81; ++i) EXPECT_NEAR(lobe[i], sum[i], 2e-4) << i;
}

}  // namespace
}  // namespace prt::transfer
