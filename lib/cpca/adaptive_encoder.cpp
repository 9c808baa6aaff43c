#include <algorithm>
#include <limits>

#include "core/log.h"
#include "cpca/allocation.h"
#include "cpca/fit.h"
#include "cpca/iterative_encoder.h"
#include "cpca/kept.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

/// Power steps after a classification, and before the first, for vectors beyond those of the
/// iterative method.
constexpr int kAdaptSteps = 2, kFirstAdaptSteps = 8;

std::vector<std::size_t> point_counts(const PointsByCluster& points) {
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k + 1 < points.offsets.size(); ++k) counts.push_back(points.of(k).size());
  return counts;
}

/// Alternations come in cycles that begin with some at a smaller budget: clusters that the
/// iterative method fitted to the same number of vectors each hardly part from it otherwise. These
/// are loose (cpca/own_factor.h).
constexpr int kCycle = 10, kTight = 5;
constexpr double kTightShare = 0.8;
/// For each iteration that is asked for.
constexpr int kAlternations = 2;

/// Classifies again and again with vectors where they are worth most. The best labels are those
/// whose allocation, all within the budget, leaves the least error.
class Adaptation {
 public:
  Adaptation(IterativeEncoder& encoder, const Options& options, std::uint32_t most,
             std::size_t budget)
      : options_(options),
        clusterer_(encoder.clusterer()),
        tail_(encoder.space().tail()),
        most_(most),
        budget_(budget) {
    allocation_.counts = clusterer_.subspaces().used;
  }

  /// Goes on with the cycle that the checkpoint of the options holds; returns how many alternations
  /// it has.
  int restore() {
    if (!restore_state(options_.checkpoint, name(), [&](Archive& from) { archive(from); }))
      return 0;
    log::info("continuing an interrupted run, which adapted {} times", errors_.size());
    return static_cast<int>(errors_.size());
  }

  /// Returns the best labels.
  std::vector<std::uint32_t> run(int count) {
    for (int i = static_cast<int>(errors_.size()); i < count; ++i) {
      if (i > 0 && i % kCycle == 0) {
        store_state(options_.checkpoint, name(), [&](Archive& to) { archive(to); });
      }
      // The first measures what the iterative method left, so that this is never worse.
      const bool is_first = i == 0;
      const bool is_tight = !is_first && i % kCycle < kTight && i + kCycle - kTight < count;
      clusterer_.update(allocation_.counts, most_, is_first ? kFirstAdaptSteps : kAdaptSteps);
      if (!is_first) allocate_vectors(is_tight);
      std::vector<std::uint32_t> labels = clusterer_.labels();
      // What a point that moves to a cluster of more vectors costs is taken from where it would
      // have saved allocation_.cost.
      const auto pass =
          clusterer_.classify(i % 5 == 0, static_cast<float>(allocation_.cost), is_tight);
      errors_.push_back(pass.error_before + tail_);
      if (!is_tight && pass.error_before < least_) {
        least_ = pass.error_before;
        best_ = std::move(labels);
      }
      if (!is_first && !is_tight && pass.moved_count == 0) break;
    }
    return std::move(best_);
  }

  /// SE before each alternation.
  const std::vector<double>& errors() const { return errors_; }

 private:
  Checkpoint::Name name() const { return {options_.checkpoint_stage, 1}; }

  void archive(Archive& archive) {
    clusterer_.archive(archive);
    archive.array(allocation_.counts);
    archive.value(allocation_.cost);
    archive.array(best_);
    archive.value(least_);
    archive.array(errors_);
  }

  void allocate_vectors(bool is_tight) {
    const Subspaces& subspaces = clusterer_.subspaces();
    std::vector<double> variances(subspaces.cluster_count() * most_);
    for (std::size_t k = 0; k < subspaces.cluster_count(); ++k) {
      std::copy_n(subspaces.variances[k].begin(), subspaces.held[k],
                  variances.begin() + static_cast<std::ptrdiff_t>(k * most_));
    }
    const auto tight = static_cast<std::size_t>(kTightShare * static_cast<double>(budget_));
    allocation_ =
        allocate(variances, most_, point_counts(clusterer_.points()), is_tight ? tight : budget_);
    clusterer_.set_used(allocation_.counts);
  }

  const Options& options_;
  Clusterer& clusterer_;
  double tail_;
  std::uint32_t most_;
  std::size_t budget_;
  Allocation allocation_;
  std::vector<std::uint32_t> best_;
  double least_ = std::numeric_limits<double>::infinity();
  std::vector<double> errors_;
};

/// Σ D_i² of the first vectors of the clusters.
double captured(std::span<const double> variances, std::size_t most,
                std::span<const std::uint32_t> counts) {
  double sum = 0.0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (std::size_t i = 0; i < counts[k]; ++i) sum += variances[k * most + i];
  }
  return sum;
}

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
  std::vector<std::uint32_t>& counts = encoding.component_counts;
  counts = allocate(variances, most,
                    point_counts(sort_by_cluster(encoding.cluster_of_point, cluster_count)), budget)
               .counts;
  std::vector<std::uint32_t> alike(cluster_count);
  for (std::size_t k = 0; k < cluster_count; ++k) {
    const std::size_t wanted = std::min(most, budget / encoding.point_count);
    while (alike[k] < wanted && variances[k * most + alike[k]] > 0.0) ++alike[k];
  }
  if (captured(variances, most, alike) > captured(variances, most, counts)) counts = alike;
  const std::size_t left = *std::max_element(counts.begin(), counts.end());
  for (std::size_t k = 0; k < cluster_count; ++k) {
    for (std::size_t i = 0; i < left; ++i) {
      float* to = &encoding.bases[(k * left + i) * n];
      if (i < counts[k]) {
        std::copy_n(&encoding.bases[(k * most + i) * n], n, to);
      } else {
        std::fill_n(to, n, 0.0f);
      }
    }
  }
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const std::size_t count = counts[encoding.cluster_of_point[p]];
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
  std::vector<std::uint32_t> labels;
  StageClock clock(encoded.stages);
  {  // what the encoder holds is gone before weights are made
    IterativeEncoder encoder(signal, n, options);
    clock.finish("seeding");
    encoded.levels = encoder.run();
    clock.finish("clustering");
    Adaptation adaptation(encoder, options, static_cast<std::uint32_t>(most.component_count),
                          budget);
    encoded.resumed_iterations = encoder.resumed_iterations() + adaptation.restore();
    labels = adaptation.run(kAlternations * options.iterations);
    encoded.levels.push_back(
        {.component_count = most.component_count, .errors = adaptation.errors()});
    encoded.flops = encoder.clusterer().flops();
    clock.finish("adaptation");
  }
  encoded.iterations = iteration_count(encoded.levels);
  encoded.encoding = fit(signal, dimension, std::move(labels), most);
  if (most.component_count > 0) trim(options.point_weights, budget, encoded.encoding);
  clock.finish("components");
  return encoded;
}

}  // namespace prt::cpca
