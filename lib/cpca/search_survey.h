// Errors of quick encodings of a sample of the points: what a search starts from.
//
// A cluster of the sample covers as much of the signal as one of as many clusters of all points,
// but with fewer points, to which its mean and vectors fit the better. Of q points with noise in
// all directions, a mean and i vectors leave 1 - (i + 1) / q of the squared error of an endless
// number of points, as each takes one degree of freedom for each coefficient. So squared errors of
// the sample are multiplied with (1 - (i + 1) / q) / (1 - (i + 1) / q_s), where q and q_s are the
// points per cluster of signal and sample.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cpca/equal_rows.h"
#include "cpca/method.h"
#include "cpca/search_model.h"

namespace prt::cpca {

struct Survey {
  ErrorModel model;
  std::size_t sampled_count = 0;  ///< points that it tells of
  /// When there are few: the survey is of them, and clusters of them are exact.
  std::optional<EqualRows> equal_rows;
  double flops = 0.0;  ///< as Encoded::flops
};

/// Encodes one cluster, without vectors of all points, as nothing is smaller, and then, unless that
/// is enough or takes less than others promise, with numbers of clusters about those that will be
/// chosen, as far as the first of them tell. Static encodings tell the errors of all numbers of
/// vectors at once, as every vector takes its share from the error of a point; iterative ones make
/// them one after the other. Of signals with fewer different rows than the sample would have
/// points, these are the sample.
Survey make_survey(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                   const Options& options);

/// Vectors of one cluster, at most: of more coefficients it is not taken apart into all of them.
constexpr int kMostWhole = 256;

/// More clusters are not worth it: points of them are as few as their vectors.
int most_clusters(std::size_t point_count);

}  // namespace prt::cpca
