// Superclusters [Sloan03] §5: groups of neighbouring clusters that are drawn as one, because the
// constants of all of them fit the registers of the hardware.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cpca/encoding.h"

namespace prt::cpca {

/// vec4 registers of a representative vector's constants [Sloan03] §6.2: one, a colour, for diffuse
/// transfer (one exit row); ⌈N_r / 4⌉ for each channel in its pass, for glossy transfer.
int registers_per_vector(int row_count);

/// m_s (n' + 1) times registers_per_vector, cluster by cluster: for adaptive CPCA n' differs.
std::vector<std::uint32_t> register_counts(const Encoding& encoding, int row_count);

/// Merges clusters greedily: always the two superclusters that share the most triangles (each is
/// then sent once less), of equal pairs the one of the lowest clusters, while any two share one and
/// fit `register_budget` together. A cluster that alone exceeds it stays alone. Returns each
/// cluster's supercluster; these are numbered by their lowest cluster.
std::vector<std::uint32_t> find_superclusters(std::span<const std::uint32_t> indices,
                                              std::span<const std::uint32_t> cluster_of_point,
                                              std::span<const std::uint32_t> register_counts,
                                              std::uint32_t register_budget);

/// Renumbers the clusters so that those of a supercluster follow each other; what the encoding
/// reconstructs stays the same. Returns the first cluster of each supercluster.
std::vector<std::uint32_t> sort_clusters(std::span<const std::uint32_t> supercluster_of_cluster,
                                         Encoding& encoding);

/// Supercluster of each point; `first_clusters` as sort_clusters returns them.
std::vector<std::uint32_t> superclusters_of_points(const Encoding& encoding,
                                                   std::span<const std::uint32_t> first_clusters);

}  // namespace prt::cpca
