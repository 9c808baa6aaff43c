// Clusters of an encoding as a start for one with some more or fewer of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cpca/encoding.h"

namespace prt::cpca {

/// The cluster of each point among `cluster_count` clusters, at most twice as many as before.
/// Clusters of the greatest error are split where their first weight changes its sign, those of the
/// least are left to the nearest mean of another. `errors`: of each point, weighted.
std::vector<std::uint32_t> resize_clusters(const Encoding& encoding, std::span<const double> errors,
                                           int cluster_count);

}  // namespace prt::cpca
