#include "sh/zonal.h"

#include <cmath>
#include <numbers>

#include "sh/basis.h"

namespace prt::sh {

namespace {
using std::numbers::pi;

// Values of the basis at an axis become coefficients of the lobe about it.
template <class T>
void scale_bands(std::span<const double> zonal, std::span<T> values) {
  const int band_count = static_cast<int>(zonal.size());
  for (int l = 0; l < band_count; ++l) {
    const auto factor =
        static_cast<T>(std::sqrt(4 * pi / (2 * l + 1)) * zonal[static_cast<std::size_t>(l)]);
    for (int m = -l; m <= l; ++m) {
      values[static_cast<std::size_t>(coefficient_index(l, m))] *= factor;
    }
  }
}

}  // namespace

// In the Legendre polynomials, 2 pi times the integral of z P_l(z) over [0, 1] is pi for l = 0,
// 2 pi / 3 for l = 1, 0 for other odd l, and for even l
//   2 pi (-1)^(l/2-1) / ((l+2)(l-1)) · l! / (2^l (l/2)!²).
std::vector<double> cosine_lobe(int band_count) {
  std::vector<double> zonal(static_cast<std::size_t>(band_count));
  double binomial = 1;  // l! / (2^l (l/2)!²) of even l
  for (int l = 0; l < band_count; ++l) {
    if (l >= 2 && l % 2 == 0) binomial *= (l - 1.0) / l;
    const double sign = l % 4 == 0 ? -1 : 1;
    const double integral = l == 1       ? 2 * pi / 3
                            : l % 2 == 1 ? 0
                                         : sign * 2 * pi / ((l + 2) * (l - 1)) * binomial;
    zonal[static_cast<std::size_t>(l)] = std::sqrt((2 * l + 1) / (4 * pi)) * integral;
  }
  return zonal;
}

// The integral of P_l over [c, 1] is (P_(l-1)(c) - P_(l+1)(c)) / (2l+1), and 1 - c for l = 0.
std::vector<double> disk_lobe(int band_count, double radius) {
  std::vector<double> zonal(static_cast<std::size_t>(band_count));
  const double c = std::cos(radius), s = std::sin(radius / 2);
  double before = 1, p = c;  // P_(l-1), P_l
  for (int l = 0; l < band_count; ++l) {
    double integral = 2 * s * s;
    if (l > 0) {
      const double next = ((2 * l + 1) * c * p - l * before) / (l + 1);
      integral = (before - next) / (2 * l + 1);
      before = p;
      p = next;
    }
    zonal[static_cast<std::size_t>(l)] = std::sqrt((2 * l + 1) * pi) * integral;
  }
  return zonal;
}

void turn_lobe(std::span<const double> zonal, const Vec3& axis, std::span<double> coefficients) {
  evaluate(static_cast<int>(zonal.size()), axis.x, axis.y, axis.z, coefficients);
  scale_bands(zonal, coefficients);
}

void turn_lobe(std::span<const double> zonal, const Vec3& axis, std::span<float> coefficients) {
  evaluate(static_cast<int>(zonal.size()), axis, coefficients);
  scale_bands(zonal, coefficients);
}

}  // namespace prt::sh
