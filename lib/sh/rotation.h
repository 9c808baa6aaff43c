// Rotation of SH coefficients: one (2l+1) x (2l+1) block per band, by the recurrence of
// [Ivanic and Ruedenberg 1996, J. Phys. Chem. 100, 6342; corrections 1998, 102, 9099].
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"

namespace prt::sh {

class Rotation {
 public:
  /// `to_from` is a proper rotation: its translation is ignored, scale and mirroring are a broken
  /// precondition. A function f becomes g with g(transform_vector(to_from, d)) = f(d).
  Rotation(int band_count, const Matrix4& to_from);

  int band_count() const { return band_count_; }
  /// Entry of the block of band l: coefficient m of the result, n of the source.
  double at(int l, int m, int n) const;

  /// band_count² coefficients each; must not overlap.
  void apply(std::span<const float> from, std::span<float> to) const;

  /// Many vectors at once, planar: coefficient i of vector v is from[i * stride + v]. `to` is laid
  /// out alike and must not overlap. stride >= count.
  void apply_batch(const float* from, float* to, std::size_t count, std::size_t stride) const;

 private:
  int band_count_;
  std::vector<double> blocks_;       // band after band, rows m, columns n
  std::vector<float> blocks_float_;  // the same
};

}  // namespace prt::sh
