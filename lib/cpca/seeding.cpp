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
constexpr std::size_t kBlock = 512;

/// One point out of each of equally long stretches of the signal, filled up with zeros to `stride`.
std::vector<float> draw_sample(std::span<const float> signal, std::size_t dimension,
                               std::size_t stride, std::size_t sample_count, Pcg32& random) {
  const std::size_t point_count = signal.size() / dimension;
  std::vector<float> sample(sample_count * stride);
  for (std::size_t s = 0; s < sample_count; ++s) {
    const std::size_t begin = s * point_count / sample_count;
    const std::size_t length = (s + 1) * point_count / sample_count - begin;
    const std::size_t point = begin + random.below(static_cast<std::uint32_t>(length));
    std::copy_n(&signal[point * dimension], dimension, &sample[s * stride]);
  }
  return sample;
}

/// Index drawn in proportion to `weights`; any when all are zero.
std::size_t draw(std::span<const double> weights, std::span<const double> block_sums,
                 Pcg32& random) {
  double total = 0.0;
  for (double sum : block_sums) total += sum;
  double rest = total * random.uniform();
  std::size_t block = 0;
  while (block + 1 < block_sums.size() && rest >= block_sums[block]) rest -= block_sums[block++];
  const std::size_t end = std::min(weights.size(), (block + 1) * kBlock);
  std::size_t chosen = block * kBlock;
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
                              std::size_t cluster_count, std::uint64_t seed) {
  const std::size_t point_count = signal.size() / dimension;
  assert(cluster_count >= 1 && cluster_count <= point_count);
  Pcg32 random(seed);
  const std::size_t sample_count =
      std::min(point_count, std::clamp(kSampleFloats / dimension, kMinPerMean * cluster_count,
                                       kMaxPerMean * cluster_count));
  const std::size_t stride = (dimension + kDistanceLanes - 1) / kDistanceLanes * kDistanceLanes;
  const std::vector<float> sample = draw_sample(signal, dimension, stride, sample_count, random);
  const auto lower = kernel_for(simd_level(), lower_avx512, lower_avx2, lower_baseline);
  std::vector<double> distances(sample_count, std::numeric_limits<double>::infinity());
  std::vector<double> block_sums(block_count(sample_count, kBlock));
  std::vector<float> means;
  std::size_t chosen = random.below(static_cast<std::uint32_t>(sample_count));
  for (std::size_t k = 0; k < cluster_count; ++k) {
    const float* mean = &sample[chosen * stride];
    means.insert(means.end(), mean, mean + dimension);
    parallel_for(sample_count, kBlock, [&](std::size_t begin, std::size_t end) {
      block_sums[begin / kBlock] =
          lower(&sample[begin * stride], stride, mean, &distances[begin], end - begin);
    });
    chosen = draw(distances, block_sums, random);
  }
  return means;
}

}  // namespace prt::cpca
