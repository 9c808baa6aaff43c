// Bounds of errors from few coordinates. A point is at least as far from a subspace as its first
// coordinates are from those of the subspace; in principal axes, which come in order of variance,
// that is most of the way.
#pragma once

#include "cpca/subspaces.h"

namespace prt::cpca {

/// The subspaces in their first `dimension` coordinates: means, and orthonormal bases of what is
/// left of the vectors in use there. Errors in them are none greater than in `subspaces`.
Subspaces find_leading(const Subspaces& subspaces, std::size_t dimension);

}  // namespace prt::cpca
