#include "cpca/quantizer.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/archive.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "cpca/clusters.h"
#include "cpca/distance.h"
#include "cpca/nearest_mean.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kNearestBlock = 14 * 32;
constexpr std::uint32_t kNone = ~0u;

/// Runs the iterations. The sum of each cluster is kept in double and follows the points that move,
/// so that only their rows are read again.
class Quantizer {
 public:
  Quantizer(std::span<const float> signal, std::size_t dimension, std::vector<float> means,
            std::span<const float> point_weights)
      : signal_(signal),
        point_weights_(point_weights),
        dimension_(dimension),
        cluster_count_(means.size() / dimension),
        sums_(means.size()),
        weights_(cluster_count_),
        counts_(cluster_count_),
        old_labels_(signal.size() / dimension, kNone) {
    result_.means = std::move(means);
    result_.labels = old_labels_;
    origin_.resize(dimension);
    for (std::size_t i = 0; i < dimension; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < cluster_count_; ++k) sum += result_.means[k * dimension + i];
      origin_[i] = static_cast<float>(sum / static_cast<double>(cluster_count_));
    }
  }

  Clustering run(int iterations, Checkpoint* checkpoint, Checkpoint::Name name) {
    const auto members = [&](Archive& state) { archive(state); };
    if (restore_state(checkpoint, name, members)) {
      result_.resumed_iterations = result_.iterations;
      log::info("continuing an interrupted run, which did {} iterations", result_.iterations);
    }
    Progress progress("clustering", static_cast<std::size_t>(iterations), "iterations");
    progress.advance(static_cast<std::size_t>(result_.iterations));
    while (result_.iterations < iterations) {
      classify();
      ++result_.iterations;
      progress.advance(1);
      if (!follow_moves()) break;
      fill_empty_clusters();
      update_means();
      store_state(checkpoint, name, members);
    }
    return std::move(result_);
  }

 private:
  void archive(Archive& archive) {
    archive.array(result_.means);
    archive.array(sums_);
    archive.array(weights_);
    archive.array(counts_);
    archive.array(old_labels_);
    archive.value(result_.iterations);
    if (archive.is_reading()) result_.labels = old_labels_;
  }

  std::span<const float> row(std::size_t point) const {
    return signal_.subspan(point * dimension_, dimension_);
  }
  std::span<const float> mean(std::size_t cluster) const {
    return {&result_.means[cluster * dimension_], dimension_};
  }

  double weight(std::size_t point) const {
    return point_weights_.empty() ? 1.0 : double{point_weights_[point]};
  }

  void classify() {
    const NearestMean nearest(result_.means, origin_);
    parallel_for(result_.labels.size(), kNearestBlock, [&](std::size_t begin, std::size_t end) {
      nearest.classify(signal_, begin, end, result_.labels);
    });
  }

  /// Brings sums and counts up to date with the labels. False when they already were.
  bool follow_moves() {
    std::vector<std::uint32_t> moved, left;
    for (std::uint32_t p = 0; p < old_labels_.size(); ++p) {
      if (result_.labels[p] == old_labels_[p]) continue;
      moved.push_back(p);
      if (old_labels_[p] != kNone) left.push_back(p);
    }
    const PointsByCluster gained = sort_by_cluster(moved, result_.labels, cluster_count_);
    const PointsByCluster lost = sort_by_cluster(left, old_labels_, cluster_count_);
    parallel_for(cluster_count_, 1, [&](std::size_t k, std::size_t) {
      add_rows(k, gained.of(k), 1.0);
      add_rows(k, lost.of(k), -1.0);
      counts_[k] += gained.of(k).size() - lost.of(k).size();
    });
    old_labels_ = result_.labels;
    return !moved.empty();
  }

  void add_rows(std::size_t cluster, std::span<const std::uint32_t> points, double sign) {
    double* sum = &sums_[cluster * dimension_];
    for (std::uint32_t point : points) {
      const float* x = &signal_[point * dimension_];
      const double share = sign * weight(point);
      weights_[cluster] += share;
      for (std::size_t i = 0; i < dimension_; ++i) sum[i] += share * double{x[i]};
    }
  }

  void fill_empty_clusters() {
    if (std::find(counts_.begin(), counts_.end(), 0) == counts_.end()) return;
    update_means();
    const std::size_t point_count = old_labels_.size();
    std::vector<double> errors(point_count);
    parallel_for(point_count, kNearestBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        errors[p] = weight(p) * squared_distance(row(p), mean(result_.labels[p]));
      }
    });
    std::vector<std::uint32_t> worst(point_count);
    std::iota(worst.begin(), worst.end(), 0u);
    std::sort(worst.begin(), worst.end(), [&](std::uint32_t a, std::uint32_t b) {
      return errors[a] != errors[b] ? errors[a] > errors[b] : a < b;
    });
    std::vector<std::size_t> left = counts_;  // no cluster gives its last point
    auto next = worst.begin();
    for (std::size_t k = 0; k < cluster_count_; ++k) {
      if (counts_[k] != 0) continue;
      while (next != worst.end() && left[result_.labels[*next]] <= 1) ++next;
      if (next == worst.end() || errors[*next] == 0.0) break;
      --left[result_.labels[*next]];
      result_.labels[*next++] = static_cast<std::uint32_t>(k);
    }
    follow_moves();
  }

  void update_means() {
    parallel_for(cluster_count_, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (counts_[k] == 0) weights_[k] = 0.0;  // without what rounding left
        if (weights_[k] <= 0.0) continue;
        for (std::size_t i = k * dimension_; i < (k + 1) * dimension_; ++i) {
          result_.means[i] = static_cast<float>(sums_[i] / weights_[k]);
        }
      }
    });
  }

  std::span<const float> signal_, point_weights_;
  std::size_t dimension_, cluster_count_;
  std::vector<float> origin_;
  std::vector<double> sums_;         // cluster_count × dimension
  std::vector<double> weights_;      // of all points in each cluster
  std::vector<std::size_t> counts_;  // points in each cluster
  std::vector<std::uint32_t> old_labels_;
  Clustering result_;
};

}  // namespace

Clustering quantize(std::span<const float> signal, std::size_t dimension, std::vector<float> means,
                    int iterations, std::span<const float> point_weights, Checkpoint* checkpoint,
                    Checkpoint::Name name) {
  assert(iterations >= 1 && !means.empty() && signal.size() >= means.size());
  return Quantizer(signal, dimension, std::move(means), point_weights)
      .run(iterations, checkpoint, name);
}

}  // namespace prt::cpca
