// The affine subspaces of all clusters as iterative encoders work on them, and the rows of points
// that they approximate. Both live in the same coordinates: those of the signal, or its first
// principal axes (cpca/principal_axes.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

/// Points as rows, `stride` numbers apart: floats, or numbers of half their size.
struct Rows {
  const float* values = nullptr;  ///< nullptr: `shorts`
  std::size_t count = 0, stride = 0;
  /// Of each point in sums of errors, >= 0; empty: 1 each.
  std::span<const float> weights = {};
  const std::int16_t* shorts = nullptr;  ///< times the scale of their coordinate
  const float* scales = nullptr;         ///< stride

  float at(std::size_t point, std::size_t d) const {
    const std::size_t i = point * stride + d;
    return values != nullptr ? values[i] : static_cast<float>(shorts[i]) * scales[d];
  }
  float weight(std::size_t point) const { return weights.empty() ? 1.0f : weights[point]; }
};

/// Rows of vectors are filled up with zeros to a multiple of this.
constexpr std::size_t kRowLanes = 32;

inline std::size_t padded(std::size_t dimension) {
  return (dimension + kRowLanes - 1) / kRowLanes * kRowLanes;
}

struct Subspaces {
  std::size_t dimension = 0;  ///< coordinates that count; the rest of a row is zero
  std::size_t stride = 0;     ///< floats of a row, at least padded(dimension)
  std::size_t capacity = 0;   ///< vectors that a cluster can hold
  /// Of each cluster (1 + capacity) × stride: mean, then vectors. Each has memory of its own, so
  /// that growing takes no second copy of all.
  std::vector<std::vector<float>> values;
  std::vector<std::uint32_t> used;  ///< vectors of each cluster that approximate points
  std::vector<std::uint32_t> held;  ///< and those that it keeps besides, for later: >= used
  /// Estimates of the squared singular values of the vectors held: cluster × capacity.
  std::vector<std::vector<double>> variances;

  Subspaces(std::size_t cluster_count, std::size_t row_stride, std::size_t vector_capacity)
      : stride(row_stride), capacity(vector_capacity) {
    resize(cluster_count);
  }

  std::size_t cluster_count() const { return used.size(); }
  /// Further clusters have no vectors.
  void resize(std::size_t cluster_count) {
    values.resize(cluster_count, std::vector<float>((1 + capacity) * stride));
    used.resize(cluster_count);
    held.resize(cluster_count);
    variances.resize(cluster_count, std::vector<double>(capacity));
  }
  /// Room for so many vectors, if there is less.
  void reserve(std::size_t vector_capacity) {
    if (vector_capacity <= capacity) return;
    capacity = vector_capacity;
    for (std::vector<float>& rows : values) {
      rows.reserve((1 + capacity) * stride);  // not the double
      rows.resize((1 + capacity) * stride);
    }
    for (std::vector<double>& variance : variances) variance.resize(capacity);
  }
  float* mean(std::size_t k) { return values[k].data(); }
  const float* mean(std::size_t k) const { return values[k].data(); }
  float* vector(std::size_t k, std::size_t i) { return mean(k) + (1 + i) * stride; }
  const float* vector(std::size_t k, std::size_t i) const { return mean(k) + (1 + i) * stride; }
};

}  // namespace prt::cpca
