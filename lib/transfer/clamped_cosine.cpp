#include "transfer/clamped_cosine.h"

#include <numbers>

#include "sh/basis.h"

namespace prt::transfer {

double clamped_cosine_factor(int l) {
  if (l == 1) return 2.0 * std::numbers::pi / 3.0;
  if (l % 2 == 1) return 0.0;
  // A_l = 2 pi (-1)^(l/2-1) / ((l+2)(l-1)) · l! / (2^l (l/2)!²), the last factor term by term.
  double factor = 2.0 * std::numbers::pi / ((l + 2.0) * (l - 1.0));
  for (int k = 1; k <= l / 2; ++k) factor *= (2.0 * k - 1.0) / (2.0 * k);
  return (l / 2) % 2 == 0 ? -factor : factor;
}

void clamped_cosine(int band_count, const Vec3& normal, std::span<float> coefficients) {
  sh::evaluate(band_count, normal, coefficients);
  for (int l = 0; l < band_count; ++l) {
    const auto factor = static_cast<float>(clamped_cosine_factor(l));
    for (int m = -l; m <= l; ++m) {
      coefficients[static_cast<std::size_t>(sh::coefficient_index(l, m))] *= factor;
    }
  }
}

}  // namespace prt::transfer
