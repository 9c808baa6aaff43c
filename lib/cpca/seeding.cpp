#include "cpca/seeding.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/cpu.h"
#include "core/parallel.h"
#include "core/random.h"
#include "cpca/distance.h"
#include "cpca/draw_points.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kSampleFloats = std::size_t{1} << 20, kMinPerMean = 16, kMaxPerMean = 64;
constexpr std::size_t kSeedingBlock = 512, kLine = 64 / sizeof(float);  ///< of a cache
/// A mean whose squared distance to another is so many times a point's is further from the point,
/// by the triangle inequality; with room for rounding.
constexpr double kFar = 4.0001;

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

/// The sample: some of the points of a signal, which stay where they are, as those of many clusters
/// are a good part of it.
struct Candidates {
  std::span<const float> signal;
  std::size_t dimension;
  std::vector<std::size_t> points;
  std::vector<double> distances;       ///< squared, to the nearest mean
  std::vector<std::uint32_t> nearest;  ///< mean

  std::span<const float> row(std::size_t s) const {
    return signal.subspan(points[s] * dimension, dimension);
  }
  /// As these rows are not one behind the other, the machine does not know which comes next.
  void prefetch(std::size_t s) const {
    for (std::size_t i = 0; i < dimension; i += kLine) __builtin_prefetch(row(s).data() + i);
  }
};

/// A mean, and its squared distances to those before.
struct NewMean {
  std::span<const float> row;
  std::uint32_t number;
  std::span<const double> apart;
};

/// Lowers distances from `begin` to `end` to those from a mean. Returns their sum.
[[gnu::always_inline]] inline double lower_distances(Candidates& sample, const NewMean& mean,
                                                     std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t s = begin; s < end; ++s) {
    if (s + 1 < end) sample.prefetch(s + 1);
    double& least = sample.distances[s];
    if (mean.number == 0 || mean.apart[sample.nearest[s]] < kFar * least) {
      const double distance = squared_distance(sample.row(s), mean.row);
      if (distance < least) {
        least = distance;
        sample.nearest[s] = mean.number;
      }
    }
    sum += least;
  }
  return sum;
}

[[gnu::target("avx512f,avx512dq,avx512vl,avx2,fma")]] double lower_avx512(Candidates& sample,
                                                                          const NewMean& mean,
                                                                          std::size_t begin,
                                                                          std::size_t end) {
  return lower_distances(sample, mean, begin, end);
}

[[gnu::target("avx2,fma")]] double lower_avx2(Candidates& sample, const NewMean& mean,
                                              std::size_t begin, std::size_t end) {
  return lower_distances(sample, mean, begin, end);
}

double lower_baseline(Candidates& sample, const NewMean& mean, std::size_t begin, std::size_t end) {
  return lower_distances(sample, mean, begin, end);
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
  Candidates sample{
      .signal = signal,
      .dimension = dimension,
      .points = draw_points(point_count, sample_count, random),
      .distances = std::vector<double>(sample_count, std::numeric_limits<double>::infinity()),
      .nearest = std::vector<std::uint32_t>(sample_count)};
  const auto lower = kernel_for(simd_level(), lower_avx512, lower_avx2, lower_baseline);
  std::vector<double> chances(point_weights.empty() ? 0 : sample_count);  // weighted distances
  std::vector<double> block_sums(block_count(sample_count, kSeedingBlock));
  std::size_t chosen = random.below(static_cast<std::uint32_t>(sample_count));
  const auto has_weight = [&](std::size_t s) {
    return point_weights.empty() || point_weights[sample.points[s]] > 0.0f;
  };
  for (std::size_t tries = 0; !has_weight(chosen) && tries < sample_count; ++tries) {
    chosen = (chosen + 1) % sample_count;
  }
  std::vector<float> means;
  means.reserve(cluster_count * dimension);
  std::vector<double> apart(cluster_count);
  for (std::uint32_t k = 0; k < cluster_count; ++k) {
    const NewMean mean{sample.row(chosen), k, apart};
    parallel_for(k, kSeedingBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t other = begin; other < end; ++other) {
        apart[other] = squared_distance({&means[other * dimension], dimension}, mean.row);
      }
    });
    means.insert(means.end(), mean.row.begin(), mean.row.end());
    parallel_for(sample_count, kSeedingBlock, [&](std::size_t begin, std::size_t end) {
      double& sum = block_sums[begin / kSeedingBlock];
      sum = lower(sample, mean, begin, end);
      if (chances.empty()) return;
      sum = 0.0;
      for (std::size_t s = begin; s < end; ++s) {
        sum += chances[s] = double{point_weights[sample.points[s]]} * sample.distances[s];
      }
    });
    chosen = draw(chances.empty() ? sample.distances : chances, block_sums, random);
  }
  return means;
}

}  // namespace prt::cpca
