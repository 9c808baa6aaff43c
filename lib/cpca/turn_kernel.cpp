#include <cmath>
#include <vector>

#include "cpca/subspace_kernels.h"
#include "cpca/subspace_tile.h"

namespace prt::cpca {

namespace {

/// Partial sums in a fixed order, so that the compiler may vectorise over them.
constexpr std::size_t kLanes = 16;

template <class B>
[[gnu::always_inline]] inline double dot(const double* a, const B* b, std::size_t n) {
  double sums[kLanes] = {}, rest = 0.0;
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums[lane] += a[i + lane] * double{b[i + lane]};
    }
  }
  for (; i < n; ++i) rest += a[i] * double{b[i]};
  for (const double sum : sums) rest += sum;
  return rest;
}

[[gnu::always_inline]] inline void add(double share, const double* from, std::size_t n,
                                       double* to) {
  for (std::size_t i = 0; i < n; ++i) to[i] += share * from[i];
}

/// Gram-Schmidt. Drops rows that are shorter than `least` then; returns how many are left.
[[gnu::always_inline]] inline std::size_t orthonormalize_rows(double* rows, std::size_t count,
                                                              std::size_t n, double least) {
  std::size_t kept = 0;
  for (std::size_t v = 0; v < count; ++v) {
    double* row = rows + kept * n;
    if (kept != v) std::copy_n(rows + v * n, n, row);
    for (std::size_t u = 0; u < kept; ++u) add(-dot(row, rows + u * n, n), rows + u * n, n, row);
    const double length = std::sqrt(dot(row, row, n));
    if (!(length > least)) continue;
    for (std::size_t i = 0; i < n; ++i) row[i] /= length;
    ++kept;
  }
  return kept;
}

[[gnu::always_inline]] inline void centre(double total_weight, Subspaces& subspaces,
                                          std::size_t cluster, std::size_t vector_count,
                                          double* moments, double* inner) {
  const std::size_t n = subspaces.dimension, stride = subspaces.stride;
  float* mean = subspaces.mean(cluster);
  const double scale = total_weight > 0.0 ? -1.0 / total_weight : 0.0;
  for (std::size_t i = 0; i < vector_count; ++i) {
    const double share = dot(moments, subspaces.vector(cluster, i), n);
    add(scale * share, moments, n, moments + (1 + i) * stride);
  }
  for (std::size_t d = 0; d < n; ++d) mean[d] -= static_cast<float>(scale * moments[d]);
  for (std::size_t i = 0; i < vector_count; ++i) {
    for (std::size_t j = 0; j < vector_count; ++j) {
      inner[i * vector_count + j] =
          dot(moments + (1 + i) * stride, subspaces.vector(cluster, j), n);
    }
  }
}

[[gnu::always_inline]] inline std::size_t turn_all(std::span<const double> rows,
                                                   std::span<const double> turn, double least,
                                                   Subspaces& subspaces, std::size_t cluster,
                                                   std::size_t vector_count) {
  const std::size_t n = subspaces.dimension;
  std::vector<double> turned(vector_count * n);
  for (std::size_t i = 0; i < vector_count; ++i) {
    for (std::size_t j = 0; j < vector_count; ++j) {
      add(turn[i * vector_count + j], &rows[j * subspaces.stride], n, &turned[i * n]);
    }
  }
  const std::size_t kept = orthonormalize_rows(turned.data(), vector_count, n, least);
  for (std::size_t v = 0; v < kept; ++v) {
    float* vector = subspaces.vector(cluster, v);
    for (std::size_t d = 0; d < n; ++d) vector[d] = static_cast<float>(turned[v * n + d]);
  }
  return kept;
}

}  // namespace

void centre_moments(double total_weight, Subspaces& subspaces, std::size_t cluster,
                    std::size_t vector_count, std::span<double> moments, std::span<double> inner,
                    SimdLevel level) {
  run_for(
      level, [&](auto) __attribute__((always_inline)) {
        centre(total_weight, subspaces, cluster, vector_count, moments.data(), inner.data());
      });
}

std::size_t turn_vectors(std::span<const double> rows, std::span<const double> turn, double least,
                         Subspaces& subspaces, std::size_t cluster, std::size_t vector_count,
                         SimdLevel level) {
  return run_for(
      level, [&](auto) __attribute__((always_inline)) {
        return turn_all(rows, turn, least, subspaces, cluster, vector_count);
      });
}

std::size_t orthonormalize(std::span<double> rows, std::size_t length, double least,
                           SimdLevel level) {
  return run_for(
      level, [&](auto) __attribute__((always_inline)) {
        return orthonormalize_rows(rows.data(), rows.size() / length, length, least);
      });
}

}  // namespace prt::cpca
