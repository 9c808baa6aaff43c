// Encodings whose worst point is within a limit. Least squares care little for single points, of
// which the worst has four to ten times the root mean square: clusters enough to bring that one
// down are a waste for all others.
//
// Points are weighted up by their error over and over, which takes the subspace of a cluster from
// least squares to the one whose greatest error is least [Lawson 1961], while they go to the
// cluster of least error as ever. The weighted mean of a cluster's errors is then least of all
// subspaces: where it is above the limit, none keeps these points to it, and the cluster is split.
// So clusters become more only where they have to. As weights may take forever to tell, less and
// less than the limit is enough, until every cluster with a point beyond it is split.
#pragma once

#include <span>

#include "cpca/encoder.h"

namespace prt::cpca {

/// Goes on from an encoding until every point's squared error, times its weight of the options, is
/// at most `limit` > 0, or there would be more than `most_clusters`, or after 400 iterations. New
/// clusters have as many vectors as those they were part of, as far as their points have so many.
/// Of the options only weights and checkpoint count. The same result for any number of threads.
void tighten(std::span<const float> signal, double limit, int most_clusters, const Options& options,
             Encoded& encoded);

}  // namespace prt::cpca
