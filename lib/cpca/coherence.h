// Cluster coherence [Sloan03] §5: fewer triangles sent when a compressed model is drawn cluster by
// cluster, by reclassification and superclusters together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "cpca/encoding.h"
#include "cpca/error_limits.h"

namespace prt::cpca {

struct CoherenceOptions {
  double error_budget =
      0.05;  ///< that reclassification may add, of the initial squared error; >= 0
  std::uint32_t register_budget = 256;  ///< vec4 constants of a supercluster
  ErrorLimits limits = {};              ///< that reclassification keeps to, and its weights
};

struct Coherence {
  std::vector<std::uint32_t> first_clusters;      ///< of each supercluster
  std::size_t triangle_count = 0;                 ///< of the mesh
  std::size_t sent_initial = 0;                   ///< triangles sent as encoded,
  std::size_t sent_reclassified = 0;              ///< after reclassification,
  std::size_t sent_superclustered = 0;            ///< and by superclusters
  std::size_t moved_count = 0;                    ///< moves of points
  double initial_error = 0.0, final_error = 0.0;  ///< squared, weighted, over all points
};

/// Reclassifies points, drops clusters that this leaves empty, finds superclusters and sorts the
/// clusters by them. `signal` is what the
/// encoding encodes, `indices` three a triangle, each < point_count; `row_count` the exit rows of
/// the transfer (cpca/superclusters.h). The same result for any number of threads. Throws Error
/// (usage) for a negative or not finite budget, Error (failed) for another number of points or an
/// index past the last.
Coherence make_coherent(std::span<const float> signal, std::span<const std::uint32_t> indices,
                        int row_count, const CoherenceOptions& options, Encoding& encoding);

/// Keys of docs/tools/prt-compress.md.
nlohmann::ordered_json to_json(const Coherence& coherence, const CoherenceOptions& options);

/// Those of them that describe an encoding as it is: overdraw_initial, triangle_count,
/// sent_triangles_initial.
nlohmann::ordered_json overdraw_to_json(std::span<const std::uint32_t> indices,
                                        const Encoding& encoding);

}  // namespace prt::cpca
