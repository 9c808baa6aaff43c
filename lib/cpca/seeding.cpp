#include "cpca/seeding.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/cpu.h"
#include "core/parallel.h"
#include "core/random.h"
#include "cpca/distance.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kSampleFloats = std::size_t{1} << 20, kMinPerMean = 16, kMaxPerMean = 64;
constexpr std::size_t kSeedingBlock = 512;

/// One point out of each of equally long stretches of so many.
std::vector<std::size_t> draw_points(std::size_t point_count, std::size_t sample_count,
                                     Pcg32& random) {
  std::vector<std::size_t> points(sample_count);
  for (std::size_t s = 0; s < sample_count; ++s) {
    const std::size_t begin = s * point_count / sample_count;
    const std::size_t length = (s + 1) * point_count / sample_count - begin;
    points[s] = begin + random.below(static_cast<std::uint32_t>(length));
  }
  return points;
}

/// Index drawn in proportion to `weights`; any when all are zero.
std::size_t draw(std::span<const double> weights, std::span<const double> block_sums,
                 Pcg32& random) {
  double total = 0.0;
  for (double sum : block_sums) total += sum;
  double rest = total * random.uniform();
  std::size_t block = 0;
  while (block + 1 < block_sums.size() && rest >= block_sums[block]) rest -= block_sums[block++];
  const std::size_t end = std::min(weights.size(), (block + 1) * kSeedingBlock);
  std::size_t chosen = block * kSeedingBlock;
  for (std::size_t i = chosen; i < end; ++i) {
    if (weights[i] <= 0.0) continue;
    chosen = i;
    if (rest < weights[i]) break;
    rest -= weights[i];
  }
  return chosen;
}

/// Lowers `distances` of points, `stride` floats apart, to those from `mean`. Returns their sum.
[[gnu::always_inline]] inline double lower_distances(const float* points, std::size_t stride,
                                                     const float* mean, double* distances,
                                                     std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = squared_distance({points + i * stride, stride}, {mean, stride});
    distances[i] = std::min(distances[i], distance);
    sum += distances[i];
  }
  return sum;
}

[[gnu::target("avx512f,avx512dq,avx512vl,avx2,fma")]] double lower_avx512(const float* points,
                                                                          std::size_t stride,
                                                                          const float* mean,
                                                                          double* distances,
                                                                          std::size_t count) {
  return lower_distances(points, stride, mean, distances, count);
}

[[gnu::target("avx2,fma")]] double lower_avx2(const float* points, std::size_t stride,
                                              const float* mean, double* distances,
                                              std::size_t count) {
  return lower_distances(points, stride, mean, distances, count);
}

double lower_baseline(const float* points, std::size_t stride, const float* mean, double* distances,
                      std::size_t count) {
  return lower_distances(points, stride, mean, distances, count);
}

}  // namespace

std::vector<float> seed_means(std::span<const float> signal, std::size_t dimension,
                              std::size_t cluster_count, std::uint64_t seed,
                              std::span<const float> point_weights) {
  const std::size_t point_count = signal.size() / dimension;
  assert(cluster_count >= 1 && cluster_count <= point_count);
  Pcg32 random(seed);
  const std::size_t sample_count =
      std::min(point_count, std::clamp(kSampleFloats / dimension, kMinPerMean * cluster_count,
                                       kMaxPerMean * cluster_count));
  const std::size_t stride = (dimension + kDistanceLanes - 1) / kDistanceLanes * kDistanceLanes;
  const std::vector<std::size_t> points = draw_points(point_count, sample_count, random);
  std::vector<float> sample(sample_count * stride);  // filled up with zeros
  for (std::size_t s = 0; s < sample_count; ++s) {
    std::copy_n(&signal[points[s] * dimension], dimension, &sample[s * stride]);
  }
  const auto lower = kernel_for(simd_level(), lower_avx512, lower_avx2, lower_baseline);
  std::vector<double> distances(sample_count, std::numeric_limits<double>::infinity());
  std::vector<double> chances(point_weights.empty() ? 0 : sample_count);  // weighted distances
  std::vector<double> block_sums(block_count(sample_count, kSeedingBlock));
  std::size_t chosen = random.below(static_cast<std::uint32_t>(sample_count));
  const auto has_weight = [&](std::size_t s) {
    return point_weights.empty() || point_weights[points[s]] > 0.0f;
  };
  for (std::size_t tries = 0; !has_weight(chosen) && tries < sample_count; ++tries) {
    chosen = (chosen + 1) % sample_count;
  }
  std::vector<float> means;
  for (std::size_t k = 0; k < cluster_count; ++k) {
    const float* mean = &sample[chosen * stride];
    means.insert(means.end(), mean, mean + dimension);
    parallel_for(sample_count, kSeedingBlock, [&](std::size_t begin, std::size_t end) {
      double& sum = block_sums[begin / kSeedingBlock];
      sum = lower(&sample[begin * stride], stride, mean, &distances[begin], end - begin);
      if (chances.empty()) return;
      sum = 0.0;
      for (std::size_t s = begin; s < end; ++s) {
        sum += chances[s] = double{point_weights[points[s]]} * distances[s];
      }
    });
    chosen = draw(chances.empty() ? distances : chances, block_sums, random);
  }
  return means;
}

}  // namespace prt::cpca
