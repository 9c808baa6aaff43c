// Coordinates of transfer matrices in which squared errors are those of exit radiance over the
// hemisphere, averaged over all lights. SH functions are far from orthogonal there: coefficients of
// some of their sums are large where radiance hardly shows them (of A, singular values down to 3e-4
// with 24 rows), and an encoder that minimised errors of the coefficients would spend itself on
// those.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace prt::sh {

/// ‖c‖² = cᵀ A c of the coefficients c of exit radiance (A: sh/hemisphere.h) is the length of
/// A^(1/2) c.
class RadianceMetric {
 public:
  /// Of signals whose rows are matrices of row_count × column_count, channel after channel; with
  /// one row, of diffuse transfer, it changes nothing. Throws Error (usage) for row counts that are
  /// no set of functions.
  RadianceMetric(int row_count, std::size_t column_count);

  bool changes_nothing() const { return row_count_ == 1; }
  /// Rows of a signal, or means and vectors of its encoding.
  void apply(std::span<float> rows) const { multiply(root_, rows); }
  void undo(std::span<float> rows) const { multiply(inverse_root_, rows); }

 private:
  void multiply(const std::vector<float>& matrix, std::span<float> rows) const;

  std::size_t row_count_, column_count_;
  std::vector<float> root_, inverse_root_;  // row_count², symmetric
};

}  // namespace prt::sh
