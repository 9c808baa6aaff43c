#include "sh/product.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "sh/basis.h"
#include "sh/quadrature.h"

namespace prt::sh {

namespace {

double wave(int m, double phi) { return m >= 0 ? std::cos(m * phi) : std::sin(-m * phi); }

// Integrals of Y_i Y_j Y_k, each an azimuth part times a polar part. Where the azimuth part is not
// 0 the orders' sum is even, so the polar part is a polynomial in z of degree 3 (bands - 1) at
// most, which the Gauss rule integrates exactly.
class TripleIntegrals {
 public:
  explicit TripleIntegrals(int band_count) : rule_((3 * band_count) / 2 + 1) {
    std::vector<double> values(row_size(band_count));
    for (double z : rule_.nodes) {
      evaluate(band_count, std::sqrt(1 - z * z), 0.0, z, values);
      polar_.push_back(values);
    }
  }

  double polar(int l1, int m1, int l2, int m2, int l3, int m3) const {
    const auto i = static_cast<std::size_t>(coefficient_index(l1, std::abs(m1)));
    const auto j = static_cast<std::size_t>(coefficient_index(l2, std::abs(m2)));
    const auto k = static_cast<std::size_t>(coefficient_index(l3, std::abs(m3)));
    double sum = 0;
    for (std::size_t n = 0; n < polar_.size(); ++n) {
      sum += rule_.weights[n] * polar_[n][i] * polar_[n][j] * polar_[n][k];
    }
    return sum;
  }

  // The mean over enough equal steps is the exact mean of a trigonometric polynomial.
  static double azimuth(int m1, int m2, int m3) {
    const int step_count = std::abs(m1) + std::abs(m2) + std::abs(m3) + 1;
    double sum = 0;
    for (int step = 0; step < step_count; ++step) {
      const double phi = 2 * std::numbers::pi * step / step_count;
      sum += wave(m1, phi) * wave(m2, phi) * wave(m3, phi);
    }
    return 2 * std::numbers::pi * sum / step_count;
  }

 private:
  GaussLegendre rule_;
  std::vector<std::vector<double>> polar_;
};

}  // namespace

// Triples that can be other than 0: orders that add up, bands that form a triangle of even sum.
ProductTable::ProductTable(int band_count) : band_count_(band_count) {
  assert(band_count >= 1 && band_count <= kMaxBandCount);
  const TripleIntegrals integrals(band_count);
  const int last = band_count - 1;
  for (int m3 = -last; m3 <= last; ++m3) {
    for (int m2 = -last; m2 <= last; ++m2) {
      for (int m1 = -last; m1 <= last; ++m1) {
        const double azimuth = TripleIntegrals::azimuth(m1, m2, m3);
        if (std::abs(azimuth) < 1e-9) continue;
        for (int l3 = std::abs(m3); l3 <= last; ++l3) {
          for (int l2 = std::abs(m2); l2 <= last; ++l2) {
            int l1 = std::max(std::abs(m1), std::abs(l3 - l2));
            l1 += (l1 + l2 + l3) % 2;
            for (; l1 <= std::min(last, l2 + l3); l1 += 2) {
              const double value = azimuth * integrals.polar(l1, m1, l2, m2, l3, m3);
              if (std::abs(value) < 1e-12) continue;
              entries_.push_back({coefficient_index(l1, m1), coefficient_index(l2, m2),
                                  coefficient_index(l3, m3), static_cast<float>(value)});
            }
          }
        }
      }
    }
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.k != b.k ? a.k < b.k : a.j != b.j ? a.j < b.j : a.i < b.i;
  });
}

void ProductTable::multiply(std::span<const float> a, std::span<const float> b,
                            std::span<float> product) const {
  const auto count = row_size(band_count_);
  assert(a.size() >= count && b.size() >= count && product.size() >= count);
  std::fill_n(product.begin(), count, 0.0f);
  for (const Entry& entry : entries_) {
    product[static_cast<std::size_t>(entry.k)] +=
        entry.value * a[static_cast<std::size_t>(entry.i)] * b[static_cast<std::size_t>(entry.j)];
  }
}

void ProductTable::matrix(std::span<const float> a, std::span<float> values) const {
  const auto count = row_size(band_count_);
  assert(a.size() >= count && values.size() >= count * count);
  std::fill_n(values.begin(), count * count, 0.0f);
  for (const Entry& entry : entries_) {
    values[static_cast<std::size_t>(entry.k) * count + static_cast<std::size_t>(entry.j)] +=
        entry.value * a[static_cast<std::size_t>(entry.i)];
  }
}

}  // namespace prt::sh
