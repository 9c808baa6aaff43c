// Classification of points by the nearest cluster mean: the inner loop of vector quantisation.
//
// ‖x - c‖² is least where x·c - ‖c‖²/2 is greatest, so all distances together are the product of
// the signal with the means. Here the product never reaches memory: a tile of points times a panel
// of means stays in registers, the maximum is taken there, and only labels are written. A common
// origin is subtracted from the means first, which leaves the order of the scores and takes the
// large common part out of their rounding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cpu.h"

namespace prt::cpca {

/// Means packed for the kernel of one instruction set.
class NearestMean {
 public:
  /// `means` is cluster_count × dimension; `origin` any point near them.
  NearestMean(std::span<const float> means, std::span<const float> origin,
              SimdLevel level = simd_level());
  NearestMean(const NearestMean&) = delete;
  NearestMean& operator=(const NearestMean&) = delete;

  /// Nearest mean of points [begin, end) of `signal` (point × dimension) into their `labels`; of
  /// equals the lowest. Every score is one chain of multiply-adds in order of the coefficients,
  /// whatever the tile that a point falls in, so labels do not depend on how points are split.
  void classify(std::span<const float> signal, std::size_t begin, std::size_t end,
                std::span<std::uint32_t> labels) const;

 private:
  SimdLevel level_;
  std::size_t dimension_;
  std::size_t panel_count_;
  std::vector<float> storage_;
  float* biases_;  // panel × lanes: -(‖c‖² - ‖origin‖²)/2; on a 64 byte boundary
  float* panels_;  // panel × dimension × lanes: c - origin
};

}  // namespace prt::cpca
