#include <algorithm>
#include <limits>

#include "cpca/allocation.h"
#include "cpca/fit.h"
#include "cpca/iterative_encoder.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

/// Power steps after a classification, and before the first, for vectors beyond those of the
/// iterative method.
constexpr int kSteps = 2, kFirstSteps = 8;

std::vector<std::size_t> point_counts(const PointsByCluster& points) {
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k + 1 < points.offsets.size(); ++k) counts.push_back(points.of(k).size());
  return counts;
}

/// Classifies again and again with vectors where they are worth most. The best labels are those
/// whose allocation, all within the budget, leaves the least error.
class Adaptation {
 public:
  Adaptation(IterativeEncoder& encoder, std::uint32_t most, std::size_t budget)
      : clusterer_(encoder.clusterer()),
        tail_(encoder.space().tail()),
        most_(most),
        budget_(budget),
        allocation_{.counts = clusterer_.subspaces().used} {}

  std::vector<std::uint32_t> run(int iterations, std::vector<double>& errors) {
    fit(kFirstSteps);
    std::vector<std::uint32_t> best = clusterer_.labels();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= iterations; ++i) {
      const std::vector<std::uint32_t> labels = clusterer_.labels();
      // What a point that moves to a cluster of more vectors costs is taken from where it would
      // have saved allocation_.cost.
      const auto pass = clusterer_.classify(i % 5 == 0, static_cast<float>(allocation_.cost));
      errors.push_back(pass.error_before + tail_);
      if (pass.error_before < least) {
        least = pass.error_before;
        best = labels;
      }
      if (pass.moved_count == 0) break;
      fit(kSteps);
    }
    return best;
  }

 private:
  void fit(int steps) {
    clusterer_.update(allocation_.counts, most_, steps);
    const Subspaces& subspaces = clusterer_.subspaces();
    std::vector<double> variances(subspaces.cluster_count() * most_);
    for (std::size_t k = 0; k < subspaces.cluster_count(); ++k) {
      std::copy_n(&subspaces.variances[k * subspaces.capacity], subspaces.held[k],
                  variances.begin() + static_cast<std::ptrdiff_t>(k * most_));
    }
    allocation_ = allocate(variances, most_, point_counts(clusterer_.points()), budget_);
    clusterer_.set_used(allocation_.counts);
  }

  Clusterer& clusterer_;
  double tail_;
  std::uint32_t most_;
  std::size_t budget_;
  Allocation allocation_;
};

/// Leaves each cluster the vectors that are worth most, of an encoding that has the same number of
/// them in each.
void trim(std::span<const float> point_weights, std::size_t budget, Encoding& encoding) {
  const auto most = static_cast<std::size_t>(encoding.component_count);
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  std::vector<double> variances(cluster_count * most);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = 0; i < most; ++i) {
      const double weight = encoding.weights[p * most + i];
      variances[encoding.cluster_of_point[p] * most + i] +=
          weight * weight * (point_weights.empty() ? 1.0 : double{point_weights[p]});
    }
  }
  encoding.component_counts =
      allocate(variances, most,
               point_counts(sort_by_cluster(encoding.cluster_of_point, cluster_count)), budget)
          .counts;
  const std::size_t left =
      *std::max_element(encoding.component_counts.begin(), encoding.component_counts.end());
  for (std::size_t k = 0; k < cluster_count; ++k) {
    for (std::size_t i = 0; i < left; ++i) {
      float* to = &encoding.bases[(k * left + i) * n];
      if (i < encoding.component_counts[k]) {
        std::copy_n(&encoding.bases[(k * most + i) * n], n, to);
      } else {
        std::fill_n(to, n, 0.0f);
      }
    }
  }
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const std::size_t count = encoding.component_counts[encoding.cluster_of_point[p]];
    for (std::size_t i = 0; i < left; ++i) {
      encoding.weights[p * left + i] = i < count ? encoding.weights[p * most + i] : 0.0f;
    }
  }
  encoding.component_count = static_cast<int>(left);
  encoding.bases.resize(cluster_count * left * n);
  encoding.weights.resize(encoding.point_count * left);
}

}  // namespace

Encoded encode_adaptive(std::span<const float> signal, int dimension, const Options& options) {
  check_options(options);
  check_signal(signal, dimension, options);
  const auto n = static_cast<std::size_t>(dimension);
  const int wanted =
      options.max_component_count > 0 ? options.max_component_count : 2 * options.component_count;
  Options most = options;
  most.component_count = std::min(wanted, dimension);
  const std::size_t budget = signal.size() / n * static_cast<std::size_t>(options.component_count);
  Encoded encoded;
  StageClock clock(encoded.stages);
  IterativeEncoder encoder(
      signal, n, options,
      static_cast<std::size_t>(std::max(most.component_count, options.component_count + 1)));
  clock.finish("seeding");
  encoded.levels = encoder.run();
  clock.finish("clustering");
  encoded.levels.push_back({.component_count = most.component_count, .errors = {}});
  Adaptation adaptation(encoder, static_cast<std::uint32_t>(most.component_count), budget);
  std::vector<std::uint32_t> labels =
      adaptation.run(options.iterations, encoded.levels.back().errors);
  for (const Level& level : encoded.levels) {
    encoded.iterations += static_cast<int>(level.errors.size());
  }
  encoded.flops = encoder.clusterer().flops();
  clock.finish("adaptation");
  encoded.encoding = fit(signal, dimension, std::move(labels), most);
  if (most.component_count > 0) trim(options.point_weights, budget, encoded.encoding);
  clock.finish("components");
  return encoded;
}

}  // namespace prt::cpca
