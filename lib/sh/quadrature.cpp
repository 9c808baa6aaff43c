#include "sh/quadrature.h"

#include <cmath>
#include <numbers>

namespace prt::sh {

// Newton's method on P_n from Tricomi's estimate of its roots; w = 2 / ((1-x²) P'_n(x)²).
GaussLegendre::GaussLegendre(int node_count) {
  for (int i = 0; i < node_count; ++i) {
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (node_count + 0.5));
    double derivative = 1;
    for (int iteration = 0; iteration < 8; ++iteration) {
      double before = 1, p = x;
      for (int n = 2; n <= node_count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      derivative = node_count * (x * p - before) / (x * x - 1);
      x -= p / derivative;
    }
    nodes.push_back(x);
    weights.push_back(2 / ((1 - x * x) * derivative * derivative));
  }
}

}  // namespace prt::sh
