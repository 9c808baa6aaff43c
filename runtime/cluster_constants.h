// The only work that a change of light costs with compressed transfer [Sloan03] §6: the dot
// products t_i·l of every cluster's mean and basis vectors with the light, for R, G and B.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "gltf/precomputed_transfer.h"
#include "sh/light.h"

namespace prt::runtime {

/// Where the constants of each cluster begin, n'_k + 1 of them; cluster_count + 1 numbers, the last
/// being how many there are.
std::vector<std::uint32_t> first_constants(const cpca::Encoding& encoding);

class ClusterConstants {
 public:
  /// Copies means and bases into an order that suits the products.
  explicit ClusterConstants(const gltf::PrecomputedTransfer& transfer);

  /// Element first_constants(encoding)[cluster] + i is t_i·l as (R, G, B, 0), the mean's at i = 0.
  /// The light may have any number of bands; those that the transfer lacks have no effect. Valid
  /// until the next call.
  const std::vector<Vec4>& evaluate(const sh::Light& light);

 private:
  int band_count_, channel_count_;
  std::size_t row_count_;          // means and vectors of all clusters
  std::vector<float> transposed_;  // [channel][coefficient][row]
  std::vector<float> sums_;        // 3 × row_count_
  std::vector<Vec4> constants_;    // row_count_
};

}  // namespace prt::runtime
