// From an encoder's result to what is stored: coherent clusters, weights as small as they may be.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/report.h"
#include "cpca/coherence.h"
#include "cpca/encoding.h"
#include "cpca/weight_format.h"

namespace prt::cpca {

struct StorageOptions {
  bool is_incoherent = false;  ///< leave clusters as they are, without superclusters
  CoherenceOptions coherence;
  std::optional<WeightFormat> weights;  ///< unset: choose_weights decides
  ErrorLimits limits = {};              ///< of both
};

struct Storage {
  std::vector<std::uint32_t> first_clusters;  ///< of superclusters; empty: every cluster is one
  WeightFormat weight_format = WeightFormat::float32;
  std::optional<Coherence> coherence;
};

/// make_coherent, then choose_weights; arguments as theirs. Adds stages "coherence" and "weights"
/// to the report. Both keep to the limits, which rounding of given weights may exceed.
Storage prepare_storage(std::span<const float> signal, std::span<const std::uint32_t> indices,
                        int row_count, const StorageOptions& options, Encoding& encoding,
                        Report& report);

}  // namespace prt::cpca
