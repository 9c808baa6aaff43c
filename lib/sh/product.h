// Products of functions given by SH coefficients, projected back onto the same bands, by the
// tripling coefficients C(i,j,k), the integrals of Y_i Y_j Y_k over the sphere, few of which are
// not 0.
#pragma once

#include <span>
#include <vector>

namespace prt::sh {

class ProductTable {
 public:
  /// Computes the coefficients once by exact quadrature; 1 to kMaxBandCount bands.
  explicit ProductTable(int band_count);

  int band_count() const { return band_count_; }
  std::size_t entry_count() const { return entries_.size(); }

  /// product_k = Σ_ij C(i,j,k) a_i b_j; band_count² coefficients each. Not the whole product: it
  /// has twice the bands, of which the upper half is cut off.
  void multiply(std::span<const float> a, std::span<const float> b, std::span<float> product) const;

  /// The symmetric matrix that multiplies by `a`: row k, column j holds Σ_i C(i,j,k) a_i.
  /// band_count² × band_count² values, row by row.
  void matrix(std::span<const float> a, std::span<float> values) const;

 private:
  struct Entry {
    int i, j, k;
    float value;
  };
  int band_count_;
  std::vector<Entry> entries_;  // ordered by k, then j, then i
};

}  // namespace prt::sh
