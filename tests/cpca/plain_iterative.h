// Iterative CPCA [Sloan03] §4.2 as it stands in the paper, in double and with nothing saved: every
// distance, every eigenvector, every time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "cpca/own_factor.h"
#include "cpca/seeding.h"
#include "linalg/decompose.h"

namespace prt::cpca {

class PlainIterative {
 public:
  PlainIterative(std::span<const float> signal, std::size_t n, std::size_t cluster_count,
                 std::uint64_t seed)
      : signal_(signal.begin(), signal.end()),
        n_(n),
        labels_(signal.size() / n),
        errors_(signal.size() / n),
        vectors_(cluster_count) {
    const auto seeds = seed_means(signal, n, cluster_count, seed);
    means_.assign(seeds.begin(), seeds.end());
  }

  /// SE in the end. With `loose` the first half of the iterations is, as in cpca/own_factor.h.
  double run(int component_count, int iterations, bool loose = false) {
    double error = 0.0;
    for (int count = 0; count <= component_count; ++count) {
      if (count > 0) fit(static_cast<std::size_t>(count));
      for (int i = 0; i < iterations; ++i) {
        const bool moved = classify(loose && i < iterations / 2);
        fill_empty();
        fit(static_cast<std::size_t>(count));
        if (!moved) break;
      }
    }
    for (std::size_t p = 0; p < labels_.size(); ++p) error += error_in(p, labels_[p]);
    return error;
  }

 private:
  double error_in(std::size_t p, std::size_t k) const {
    const double *x = &signal_[p * n_], *mean = &means_[k * n_];
    double error = 0.0;
    for (std::size_t i = 0; i < n_; ++i) error += (x[i] - mean[i]) * (x[i] - mean[i]);
    for (std::size_t v = 0; v < vectors_[k].size() / n_; ++v) {
      double share = 0.0;
      for (std::size_t i = 0; i < n_; ++i) share += (x[i] - mean[i]) * vectors_[k][v * n_ + i];
      error -= share * share;
    }
    return error;
  }

  bool classify(bool loose) {
    const std::vector<std::uint32_t> before = labels_;
    std::vector<std::size_t> sizes(vectors_.size());
    for (const std::uint32_t k : labels_) ++sizes[k];
    parallel_for(labels_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const std::uint32_t own = labels_[p];
        errors_[p] = error_in(p, own);
        double least = errors_[p];
        if (loose) least *= own_factor(vectors_[own].size() / n_, sizes[own]);
        for (std::uint32_t k = 0; k < vectors_.size(); ++k) {
          const double error = error_in(p, k);
          if (k != own && error < least) least = errors_[p] = error, labels_[p] = k;
        }
      }
    });
    return labels_ != before;
  }

  void fill_empty() {
    for (std::uint32_t k = 0; k < vectors_.size(); ++k) {
      if (std::count(labels_.begin(), labels_.end(), k) > 0) continue;
      const auto worst = std::max_element(errors_.begin(), errors_.end()) - errors_.begin();
      if (errors_[static_cast<std::size_t>(worst)] <= 0.0) return;
      labels_[static_cast<std::size_t>(worst)] = k;
      errors_[static_cast<std::size_t>(worst)] = 0.0;
    }
  }

  void fit(std::size_t count) {
    parallel_for(vectors_.size(), 1, [&](std::size_t k, std::size_t) {
      std::vector<std::size_t> points;
      for (std::size_t p = 0; p < labels_.size(); ++p) {
        if (labels_[p] == k) points.push_back(p);
      }
      if (points.empty()) return;
      double* mean = &means_[k * n_];
      std::fill_n(mean, n_, 0.0);
      for (std::size_t p : points) {
        for (std::size_t i = 0; i < n_; ++i) {
          mean[i] += signal_[p * n_ + i] / static_cast<double>(points.size());
        }
      }
      std::vector<double> covariance(n_ * n_);
      for (std::size_t p : points) {
        for (std::size_t i = 0; i < n_; ++i) {
          for (std::size_t j = 0; j < n_; ++j) {
            covariance[i * n_ + j] +=
                (signal_[p * n_ + i] - mean[i]) * (signal_[p * n_ + j] - mean[j]);
          }
        }
      }
      vectors_[k] = linalg::largest_eigenpairs(linalg::MatrixD{covariance.data(), n_, n_},
                                               std::min({count, points.size() - 1, n_}))
                        .vectors;
    });
  }

  std::vector<double> signal_;
  std::size_t n_;
  std::vector<double> means_;
  std::vector<std::uint32_t> labels_;
  std::vector<double> errors_;
  std::vector<std::vector<double>> vectors_;
};

}  // namespace prt::cpca
