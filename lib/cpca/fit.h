// The best encoding for a given classification: what every encoder ends with.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cpca/encoder.h"
#include "cpca/encoding.h"

namespace prt::cpca {

/// Mean of the points of each cluster, cluster_count × dimension, in double until the end. The mean
/// of no points is 0. `point_weights` may be empty.
std::vector<float> fit_means(std::span<const float> signal, std::size_t dimension,
                             std::span<const std::uint32_t> labels, std::size_t cluster_count,
                             std::span<const float> point_weights);

/// Fills in bases and weights of an encoding that has means and the cluster of every point: the
/// principal components of each cluster.
void fit_components(std::span<const float> signal, std::span<const float> point_weights,
                    Encoding& encoding);

/// Fills in the weights of an encoding that has all else.
void fit_weights(std::span<const float> signal, Encoding& encoding);

/// Means, then components, with the counts and point weights of the options.
Encoding fit(std::span<const float> signal, int dimension, std::vector<std::uint32_t> labels,
             const Options& options);

}  // namespace prt::cpca
