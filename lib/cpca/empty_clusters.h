// Clusters that no point belongs to: an encoder may lose a cluster's last point, and
// reclassification moves it away where that saves triangles.
#pragma once

#include "cpca/encoding.h"

namespace prt::cpca {

/// Leaves them out; the others keep their order, and every point what it reconstructs to. Of
/// adaptive encodings component_count becomes the most that a cluster left has. Encodings of no
/// points stay.
void drop_empty_clusters(Encoding& encoding);

}  // namespace prt::cpca
