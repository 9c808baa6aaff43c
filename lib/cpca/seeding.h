// First means of vector quantisation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

/// k-means++ [Arthur and Vassilvitskii 2007]: points drawn one after the other with a probability
/// in proportion to their squared distance to those drawn before. Drawn from a stratified sample
/// of the signal, 16 to 64 points a mean, read where they are. Chances, but of the first, are
/// multiplied with `point_weights` (empty: 1); points of weight 0 are never drawn. Returns
/// cluster_count × dimension; the same for any number of threads.
std::vector<float> seed_means(std::span<const float> signal, std::size_t dimension,
                              std::size_t cluster_count, std::uint64_t seed,
                              std::span<const float> point_weights = {});

}  // namespace prt::cpca
