#include "cpca/tighten.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "cpca/clusterer.h"
#include "cpca/distance.h"
#include "cpca/error_limits.h"
#include "cpca/fit.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

/// After so many iterations the weights of points do not decide any more.
constexpr int kPatience = 72, kMostIterations = 400;
/// Full passes, and splits, are as far apart. States are kept after full passes.
constexpr int kFullPeriod = 16, kSplitPeriod = 4;
/// Of the clusters that should be split, those that are: neighbours may relieve the others.
constexpr double kSplitShare = 0.5;
/// Weights of points; they are multiplied with their error, as a share of the limit, and some more.
constexpr float kLeastWeight = 1e-2f, kMostWeight = 1e3f, kMore = 0.1f;
/// Power steps after a classification, and where vectors start from nothing.
constexpr int kTightenSteps = 1, kFirstTightenSteps = 8;

class Tightener {
 public:
  Tightener(std::span<const float> signal, double limit, const Options& options,
            const Encoding& start)
      : signal_(signal),
        n_(static_cast<std::size_t>(start.dimension)),
        limit_(limit),
        options_(options),
        is_adaptive_(!start.component_counts.empty()),
        component_count_(static_cast<std::uint32_t>(start.component_count)),
        weights_(start.point_count, 1.0f),
        row_weights_(weights_),
        shares_(start.point_count),
        clusterer_({signal.data(), start.point_count, n_, row_weights_}, n_, start.means) {
    for (int k = 0; k < start.cluster_count; ++k) {
      wanted_.push_back(static_cast<std::uint32_t>(start.component_count_of(k)));
    }
    clusterer_.set_labels(start.cluster_of_point);
    weigh_rows();
  }

  /// Returns how many iterations it took.
  int run(int most_clusters) {
    int i = 0;
    const Checkpoint::Name name{options_.checkpoint_stage, 2};
    const auto members = [&](Archive& archive) {
      archive.value(i);
      archive.array(wanted_);
      archive.array(weights_);
      clusterer_.archive(archive);
    };
    if (restore_state(options_.checkpoint, name, members)) {
      weigh_rows();
    } else {
      update(kFirstTightenSteps);
    }
    for (; i < kMostIterations; ++i) {
      if (i > 0 && i % kFullPeriod == 0) store_state(options_.checkpoint, name, members);
      clusterer_.classify(i % kFullPeriod == 0);
      if (is_within_limit()) break;
      const std::vector<double> means = mean_shares();
      weigh(means);
      if (i % kSplitPeriod == kSplitPeriod - 1) {
        const std::vector<std::uint32_t> parents = choose_parents(means, i);
        if (wanted_.size() + parents.size() > static_cast<std::size_t>(most_clusters)) break;
        split(parents);
      }
      update(kTightenSteps);
    }
    return i;
  }

  /// As measured last.
  Encoding encoding() const {
    const Subspaces& subspaces = clusterer_.subspaces();
    const std::size_t count = component_count_, cluster_count = wanted_.size();
    Encoding encoding{
        .point_count = shares_.size(),
        .dimension = static_cast<int>(n_),
        .cluster_count = static_cast<int>(cluster_count),
        .component_count = static_cast<int>(count),
        .means = std::vector<float>(cluster_count * n_),
        .bases = std::vector<float>(cluster_count * count * n_),
        .component_counts = is_adaptive_ ? subspaces.used : std::vector<std::uint32_t>(),
        .cluster_of_point = clusterer_.labels(),
        .weights = {}};
    for (std::size_t k = 0; k < cluster_count; ++k) {
      std::copy_n(subspaces.mean(k), n_, &encoding.means[k * n_]);
      for (std::uint32_t v = 0; v < subspaces.used[k]; ++v) {
        std::copy_n(subspaces.vector(k, v), n_,
                    encoding.bases.begin() + static_cast<std::ptrdiff_t>((k * count + v) * n_));
      }
    }
    fit_weights(signal_, encoding);
    return encoding;
  }

  double flops() const { return clusterer_.flops(); }

 private:
  void update(int steps) { clusterer_.update(wanted_, component_count_ + 1, steps); }

  double point_weight(std::size_t p) const {
    return options_.point_weights.empty() ? 1.0 : double{options_.point_weights[p]};
  }

  void weigh_rows() {
    for (std::size_t p = 0; p < weights_.size(); ++p) {
      row_weights_[p] = static_cast<float>(double{weights_[p]} * point_weight(p));
    }
  }

  bool all_within() const {
    return std::all_of(shares_.begin(), shares_.end(), [](float share) { return share <= 1.0f; });
  }

  /// Finds the errors of points as shares of the limit: at last not from what rounding leaves of
  /// large squares, but from the points as they will be.
  bool is_within_limit() {
    for (std::size_t p = 0; p < shares_.size(); ++p) {
      shares_[p] = static_cast<float>(double{clusterer_.errors()[p]} * point_weight(p) / limit_);
    }
    if (!all_within()) return false;
    const std::vector<double> errors = weighted_errors(encoding(), signal_, options_.point_weights);
    std::transform(errors.begin(), errors.end(), shares_.begin(), [&](double error) {
      return error > limit_ ? std::max(static_cast<float>(error / limit_), 1.0001f)
                            : static_cast<float>(error / limit_);
    });
    return all_within();
  }

  /// Of each cluster, by the weights of its points.
  std::vector<double> mean_shares() const {
    std::vector<double> sums(wanted_.size()), totals(wanted_.size());
    for (std::size_t p = 0; p < shares_.size(); ++p) {
      const std::uint32_t k = clusterer_.labels()[p];
      sums[k] += double{weights_[p]} * double{shares_[p]};
      totals[k] += double{weights_[p]};
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      if (totals[k] > 0.0) sums[k] /= totals[k];
    }
    return sums;
  }

  /// Where all points are well within the limit that leads back to equal weights.
  void weigh(std::span<const double> means) {
    for (std::size_t p = 0; p < weights_.size(); ++p) {
      const auto mean = static_cast<float>(std::max(1.0, means[clusterer_.labels()[p]]));
      weights_[p] =
          std::clamp(weights_[p] * (shares_[p] / mean + kMore), kLeastWeight, kMostWeight);
    }
    weigh_rows();
  }

  /// Of each cluster the point of greatest error.
  std::vector<std::uint32_t> worst_points() const {
    std::vector<std::uint32_t> worst(wanted_.size());
    for (std::size_t k = 0; k < worst.size(); ++k) {
      const auto points = clusterer_.points().of(k);
      if (points.empty()) continue;
      worst[k] = *std::max_element(
          points.begin(), points.end(),
          [&](std::uint32_t a, std::uint32_t b) { return shares_[a] < shares_[b]; });
    }
    return worst;
  }

  /// The clusters to split now, those of the greatest error first.
  std::vector<std::uint32_t> choose_parents(std::span<const double> means, int iteration) const {
    const std::vector<std::uint32_t> worst = worst_points();
    const double enough = 1.0 - static_cast<double>(iteration) / kPatience;
    std::vector<std::uint32_t> parents;
    for (std::uint32_t k = 0; k < means.size(); ++k) {
      if (clusterer_.points().of(k).size() > 1 && shares_[worst[k]] > 1.0f && means[k] > enough) {
        parents.push_back(k);
      }
    }
    std::stable_sort(parents.begin(), parents.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return means[a] > means[b]; });
    const double share = enough > 0.0 ? kSplitShare : 1.0;
    parents.resize(
        static_cast<std::size_t>(std::ceil(share * static_cast<double>(parents.size()))));
    return parents;
  }

  /// Points nearer to the worst of their cluster than to its mean leave with it.
  void split(std::span<const std::uint32_t> parents) {
    if (parents.empty()) return;
    const std::vector<std::uint32_t> worst = worst_points();
    std::vector<std::uint32_t> labels = clusterer_.labels();
    const auto count = static_cast<std::uint32_t>(wanted_.size());
    const auto row = [&](std::uint32_t p) { return signal_.subspan(p * n_, n_); };
    parallel_for(parents.size(), 1, [&](std::size_t i, std::size_t) {
      const std::uint32_t k = parents[i];
      const std::span mean(clusterer_.subspaces().mean(k), n_);
      for (const std::uint32_t p : clusterer_.points().of(k)) {
        const bool leaves =
            squared_distance(row(p), row(worst[k])) < squared_distance(row(p), mean);
        if (leaves || p == worst[k]) labels[p] = count + static_cast<std::uint32_t>(i);
      }
    });
    for (const std::uint32_t k : parents) wanted_.push_back(wanted_[k]);
    clusterer_.grow(parents, labels);
  }

  const std::span<const float> signal_;
  const std::size_t n_;
  const double limit_;
  const Options& options_;
  const bool is_adaptive_;
  const std::uint32_t component_count_;  ///< the most of a cluster
  std::vector<std::uint32_t> wanted_;    ///< vectors of each
  std::vector<float> weights_;           ///< of points, from their errors
  std::vector<float> row_weights_;       ///< times those of the options
  std::vector<float> shares_;            ///< errors over the limit
  Clusterer clusterer_;
};

}  // namespace

void tighten(std::span<const float> signal, double limit, int most_clusters, const Options& options,
             Encoded& encoded) {
  StageClock clock(encoded.stages);
  Tightener tightener(signal, limit, options, encoded.encoding);
  encoded.encoding = {};  // room for another
  encoded.iterations += tightener.run(most_clusters);
  encoded.encoding = tightener.encoding();
  encoded.flops += tightener.flops();
  clock.finish("tightening");
}

}  // namespace prt::cpca
