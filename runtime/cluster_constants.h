// The only work that a change of light costs with compressed transfer [Sloan03] §6: the dot
// products t_i·l of every cluster's mean and basis vectors with the light, for R, G and B.
#pragma once

#include <vector>

#include "core/vec.h"
#include "gltf/precomputed_transfer.h"
#include "sh/light.h"

namespace prt::runtime {

class ClusterConstants {
 public:
  /// Copies means and bases into an order that suits the products.
  explicit ClusterConstants(const gltf::PrecomputedTransfer& transfer);

  /// Element cluster × (component_count + 1) + i is t_i·l as (R, G, B, 0), the mean's at i = 0. The
  /// light may have any number of bands; those that the transfer lacks have no effect. Valid until
  /// the next call.
  const std::vector<Vec4>& evaluate(const sh::Light& light);

 private:
  int band_count_, channel_count_;
  std::size_t row_count_;          // cluster_count × (component_count + 1)
  std::vector<float> transposed_;  // [channel][coefficient][row]
  std::vector<float> sums_;        // 3 × row_count_
  std::vector<Vec4> constants_;    // row_count_
};

}  // namespace prt::runtime
