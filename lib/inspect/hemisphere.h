// The error analysis of hemispherical SH projections, [Sloan03] appendix, from our own matrices.
#pragma once

#include "inspect/inspection.h"

namespace prt::inspect {

/// What the appendix prints for signals of 5 bands: singular values of A, the cost of dropping
/// l = 1, m = 0, and worst and mean squared error (and their roots) of every projection.
Json hemisphere_table();

}  // namespace prt::inspect
