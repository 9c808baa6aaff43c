// Gauss-Legendre quadrature in double precision.
#pragma once

#include <vector>

namespace prt::sh {

/// Exact for polynomials up to degree 2 node_count - 1 on [-1, 1].
struct GaussLegendre {
  explicit GaussLegendre(int node_count);
  std::vector<double> nodes, weights;
};

}  // namespace prt::sh
