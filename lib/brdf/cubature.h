// Adaptive integration of vectors of functions over intervals and rectangles, in double precision,
// by Gauss-Kronrod rules of 7 and 15 points [Piessens et al. 1983, QUADPACK].
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace prt::brdf {

struct Point {
  double x, y;
};

/// A rectangle, or, with y0 = y1, the interval [x0, x1] at this y.
struct Box {
  double x0, x1, y0, y1;
};

/// Writes `value_count` values for each point, one point after the other. Points come in whole
/// boxes, so that an expensive integrand can work on them in parallel.
using Integrand = std::function<void(std::span<const Point> points, std::span<double> values)>;

struct CubatureOptions {
  std::size_t value_count = 1;
  std::size_t controlled_count = 1;  ///< the first of the values, whose error counts
  double tolerance = 1e-6;           ///< absolute, of each controlled value
  std::size_t max_box_count = 4000;
};

struct CubatureResult {
  std::vector<double> values;
  double error = 0;  ///< estimated bound of the greatest error of a controlled value
  bool converged = false;
};

/// The integral over all boxes together, which are halved where the estimated error (the difference
/// of the two rules) is greatest, until their sum is within the tolerance or there are too many.
/// The same input gives the same bits.
CubatureResult integrate(std::span<const Box> boxes, const Integrand& integrand,
                         const CubatureOptions& options);

}  // namespace prt::brdf
