#include <algorithm>
#include <limits>

#include "core/log.h"
#include "cpca/allocation.h"
#include "cpca/fit.h"
#include "cpca/iterative_encoder.h"
#include "cpca/kept.h"
#include "cpca/stage_clock.h"
#include "cpca/trim.h"

namespace prt::cpca {

namespace {

/// Power steps after a classification, and before the first, for vectors beyond those of the
/// iterative method.
constexpr int kAdaptSteps = 2, kFirstAdaptSteps = 8;

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
