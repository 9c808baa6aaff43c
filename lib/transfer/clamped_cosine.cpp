#include "transfer/clamped_cosine.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "sh/basis.h"
#include "sh/zonal.h"

namespace prt::transfer {

void clamped_cosine(int band_count, const Vec3& normal, std::span<float> coefficients) {
  const std::vector<double> lobe = sh::cosine_lobe(band_count);
  sh::evaluate(band_count, normal, coefficients);
  for (int l = 0; l < band_count; ++l) {
    const auto factor = static_cast<float>(std::sqrt(4.0 * std::numbers::pi / (2 * l + 1)) *
                                           lobe[static_cast<std::size_t>(l)]);
    for (int m = -l; m <= l; ++m) {
      coefficients[static_cast<std::size_t>(sh::coefficient_index(l, m))] *= factor;
    }
  }
}

}  // namespace prt::transfer
