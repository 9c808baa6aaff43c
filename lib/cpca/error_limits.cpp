#include "cpca/error_limits.h"

namespace prt::cpca {

std::vector<double> weighted_errors(const Encoding& encoding, std::span<const float> signal,
                                    std::span<const float> point_weights) {
  std::vector<double> errors = point_errors(encoding, signal);
  for (std::size_t p = 0; p < point_weights.size(); ++p) errors[p] *= double{point_weights[p]};
  return errors;
}

}  // namespace prt::cpca
