// Coordinates in which plain squared errors are what is asked for, and numbers are moderate.
#pragma once

#include <span>
#include <vector>

#include "cpca/encoding.h"
#include "cpca/weight_format.h"

namespace prt::compress {

/// Coefficients are multiplied with the root of their weight over the greatest of the weights, and
/// all with the power of two that brings the greatest of the signal between 1 and 2: so encoders,
/// which square floats, take signals of any size, and those without weights not a bit differently.
class Scaling {
 public:
  /// Weights above 0 of each coefficient, or none: 1 each.
  Scaling(std::span<const float> signal, std::span<const float> coefficient_weights);

  void apply(std::span<float> rows) const;
  void undo(std::span<float> rows) const;
  /// Back to the signal's coordinates; of float weights the power of two goes to them, so that
  /// vectors stay of length 1.
  void undo(cpca::WeightFormat format, cpca::Encoding& encoding) const;
  /// Weighted squared errors over those of scaled signals.
  double square() const;

 private:
  std::vector<double> roots_;  ///< of each coefficient, at most 1; or a single 1
  double greatest_ = 1.0;      ///< weight
  int exponent_ = 0;
};

}  // namespace prt::compress
