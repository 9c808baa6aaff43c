// One point in the subspace of one cluster.
#pragma once

#include <span>

#include "cpca/encoding.h"

namespace prt::cpca {

/// Writes the weights of `x` (dimension floats) in the subspace of `cluster`, (x - mean)·basis_i
/// and zeros for vectors that the cluster does not have, into `weights` (component_count floats).
/// Returns the squared error ‖x - x̃‖² that point_errors will find for them.
double project_point(const Encoding& encoding, int cluster, std::span<const float> x,
                     std::span<float> weights);

}  // namespace prt::cpca
