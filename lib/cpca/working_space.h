// The coordinates that iterative encoders work in: as many principal axes of the signal as matter
// beside the error that is left, or the signal itself where it has few coefficients or no such
// axes. A quarter of the signal in memory.
#pragma once

#include <span>

#include "core/archive.h"
#include "cpca/principal_axes.h"
#include "cpca/subspaces.h"

namespace prt::cpca {

class WorkingSpace {
 public:
  /// Without `axes` the signal itself.
  WorkingSpace(std::span<const float> signal, std::size_t dimension, std::span<const float> weights,
               bool axes = true);

  const Rows& rows() const { return rows_; }
  std::size_t dimension() const { return dimension_; }
  bool has_axes() const { return !axes_.tails.empty(); }
  /// Σ_p weight_p ‖what the coordinates in use leave out of x_p‖², part of every error.
  double tail() const { return has_axes() ? axes_.tails[dimension_] : 0.0; }

  /// As many coordinates as an error calls for. True when rows() are others now.
  bool fit_to(double error);
  /// All coordinates. True when rows() are others now.
  bool use_signal();
  /// Those, whatever is in use.
  Rows signal_rows() const {
    return {signal_.data(), rows_.count, signal_dimension_, rows_.weights};
  }

  /// Which coordinates are in use.
  void archive(Archive& archive);

  /// Points of the signal's coordinates (count × dimension) in those of rows(), stride of rows().
  std::vector<float> convert(std::span<const float> points) const;

 private:
  std::span<const float> signal_;
  std::size_t signal_dimension_;
  PrincipalAxes axes_;  ///< empty: the signal's own
  Rows rows_;
  std::size_t dimension_;
};

}  // namespace prt::cpca
