// The only work that a change of light costs with compressed transfer [Sloan03] §6: the products
// M_i l of every cluster's mean and basis vectors with the light, for R, G and B; dot products when
// the transfer is diffuse.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "gltf/precomputed_transfer.h"
#include "runtime/exit_layout.h"
#include "sh/light.h"

namespace prt::runtime {

/// Where the constants of each cluster begin, n'_k + 1 of them; cluster_count + 1 numbers, the last
/// being how many there are.
std::vector<std::uint32_t> first_constants(const cpca::Encoding& encoding);

class ClusterConstants {
 public:
  /// Copies means and bases into an order that suits the products.
  ClusterConstants(const gltf::PrecomputedTransfer& transfer, ExitLayout layout);

  /// For pass after pass and constant after constant, layout.pass_vector_count() vec4. Constant
  /// first_constants(encoding)[cluster] + i is M_i l, the mean's at i = 0. The light may have any
  /// number of bands; those that the transfer lacks have no effect. Valid until the next call.
  const std::vector<Vec4>& evaluate(const sh::Light& light);

 private:
  void place_sums();

  ExitLayout layout_;
  int band_count_, channel_count_;
  std::size_t constant_count_;  // means and vectors of all clusters
  std::size_t column_count_;    // of each colour: a constant's slots, one when diffuse; padded
  std::vector<float> blocks_;   // [block of columns][channel][source coefficient][column]
  std::vector<float> sums_;     // [colour][column]
  std::vector<Vec4> constants_;
};

}  // namespace prt::runtime
