// Leaves clusters the vectors that are worth most.
#pragma once

#include <cstddef>
#include <span>

#include "cpca/encoding.h"
#include "cpca/search_choice.h"

namespace prt::cpca {

/// Of an encoding with weights, those that a budget of Σ_k m_k n'_k allows [Sloan03] §4.3, by
/// D_i²/m_k, or the same number in each cluster where that leaves less error.
void trim(std::span<const float> point_weights, std::size_t budget, Encoding& encoding);

/// The same, until it takes no more bytes than that, or has no vectors left.
void trim_to_bytes(std::span<const float> point_weights, const StorageCost& cost,
                   std::size_t max_bytes, Encoding& encoding);

}  // namespace prt::cpca
