#include "reference/sampler.h"

#include <gtest/gtest.h>

#include <set>

namespace prt::reference {
namespace {

TEST(Sampler, EveryElementaryIntervalHasOnePoint) {
  constexpr int kLog = 8, kCount = 1 << kLog;
  for (std::uint32_t seed : {1u, 77u, 0xdeadbeefu}) {
    for (int columns_log = 0; columns_log <= kLog; ++columns_log) {
      const int columns = 1 << columns_log, rows = kCount / columns;
      std::set<int> cells;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vec2 p = sobol_point(i, seed);
        ASSERT_TRUE(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f);
        const auto column = static_cast<int>(p.x * static_cast<float>(columns));
        const auto row = static_cast<int>(p.y * static_cast<float>(rows));
        cells.insert(row * columns + column);
      }
      EXPECT_EQ(cells.size(), static_cast<std::size_t>(kCount)) << columns << " columns";
    }
  }
}

// Over seeds, the first point is uniform and independent of the second: mean 1/2, covariance 0. The
// standard deviations of these estimates from n seeds are 0.29 / sqrt(n) and 0.083 / sqrt(n).
TEST(Sampler, SeedsAreIndependentAndUniform) {
  constexpr int kSeeds = 20000;
  double mean = 0.0, covariance = 0.0;
  for (std::uint32_t i = 0; i < kSeeds; ++i) {
    const Vec2 p = sobol_point(0, hash_combine(i, 5));
    const Vec2 q = sobol_point(0, hash_combine(i, 6));
    mean += p.x / kSeeds;
    covariance += (p.x - 0.5) * (q.x - 0.5) / kSeeds;
  }
  EXPECT_NEAR(mean, 0.5, 4 * 0.29 / std::sqrt(kSeeds));
  EXPECT_NEAR(covariance, 0.0, 4 * 0.083 / std::sqrt(kSeeds));
}

}  // namespace
}  // namespace prt::reference
