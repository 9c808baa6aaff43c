#include "sh/rotation.h"

#include <cassert>
#include <cmath>
#include <cstdlib>

#include "sh/basis.h"

namespace prt::sh {

namespace {

// Where the block of band l starts: the sum of (2k+1)² over k < l.
std::size_t block_offset(int l) { return static_cast<std::size_t>(l * (4 * l * l - 1) / 3); }

std::size_t entry_offset(int l, int m, int n) {
  return block_offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l);
}

// The recurrence in the paper's terms: R(m,n) of band l from those of bands 1 and l-1, for the
// harmonics without the Condon-Shortley phase, whose band 1 is (y, z, x).
class Recurrence {
 public:
  explicit Recurrence(std::vector<double>& blocks) : blocks_(blocks) {}

  double entry(int l, int m, int n) const {
    const int k = std::abs(m);
    const double d = std::abs(n) < l ? (l + n) * (l - n) : 2 * l * (2 * l - 1);
    const double u = std::sqrt((l + m) * (l - m) / d);
    const double v =
        0.5 * std::sqrt((m == 0 ? 2 : 1) * (l + k - 1) * (l + k) / d) * (m == 0 ? -1 : 1);
    const double w = m == 0 ? 0 : -0.5 * std::sqrt((l - k - 1) * (l - k) / d);
    double sum = 0;
    if (u != 0) sum += u * p(0, l, m, n);
    if (v != 0) sum += v * v_term(l, m, n);
    if (w != 0) sum += w * w_term(l, m, n);
    return sum;
  }

 private:
  double r(int l, int m, int n) const { return blocks_[entry_offset(l, m, n)]; }

  double p(int i, int l, int m, int n) const {
    if (n == l) return r(1, i, 1) * r(l - 1, m, l - 1) - r(1, i, -1) * r(l - 1, m, 1 - l);
    if (n == -l) return r(1, i, 1) * r(l - 1, m, 1 - l) + r(1, i, -1) * r(l - 1, m, l - 1);
    return r(1, i, 0) * r(l - 1, m, n);
  }

  double v_term(int l, int m, int n) const {
    if (m == 0) return p(1, l, 1, n) + p(-1, l, -1, n);
    if (m == 1) return std::sqrt(2.0) * p(1, l, 0, n);
    if (m == -1) return std::sqrt(2.0) * p(-1, l, 0, n);
    if (m > 0) return p(1, l, m - 1, n) - p(-1, l, 1 - m, n);
    return p(1, l, m + 1, n) + p(-1, l, -m - 1, n);
  }

  double w_term(int l, int m, int n) const {
    if (m > 0) return p(1, l, m + 1, n) + p(-1, l, -m - 1, n);
    return p(1, l, m - 1, n) - p(-1, l, 1 - m, n);
  }

  std::vector<double>& blocks_;
};

}  // namespace

Rotation::Rotation(int band_count, const Matrix4& to_from)
    : band_count_(band_count), blocks_(block_offset(band_count)) {
  assert(band_count >= 0 && band_count <= kMaxBandCount);
  if (band_count > 0) blocks_[0] = 1;
  constexpr int kAxes[3] = {1, 2, 0};  // y, z, x
  for (int m = -1; m <= 1 && band_count > 1; ++m) {
    for (int n = -1; n <= 1; ++n) {  // Imath's matrices act on row vectors
      blocks_[entry_offset(1, m, n)] = double{to_from[kAxes[n + 1]][kAxes[m + 1]]};
    }
  }
  const Recurrence recurrence(blocks_);
  for (int l = 2; l < band_count; ++l) {
    for (int m = -l; m <= l; ++m) {
      for (int n = -l; n <= l; ++n) blocks_[entry_offset(l, m, n)] = recurrence.entry(l, m, n);
    }
  }
  for (int l = 1; l < band_count; ++l) {  // our phase: Y(l,m) carries (-1)^m
    for (int m = -l; m <= l; ++m) {
      for (int n = -l; n <= l; ++n) {
        if ((m + n) % 2 != 0) blocks_[entry_offset(l, m, n)] *= -1;
      }
    }
  }
  blocks_float_.assign(blocks_.begin(), blocks_.end());
}

double Rotation::at(int l, int m, int n) const {
  assert(l >= 0 && l < band_count_ && std::abs(m) <= l && std::abs(n) <= l);
  return blocks_[entry_offset(l, m, n)];
}

void Rotation::apply(std::span<const float> from, std::span<float> to) const {
  assert(from.size() >= row_size(band_count_));
  assert(to.size() >= row_size(band_count_));
  for (int l = 0; l < band_count_; ++l) {
    for (int m = -l; m <= l; ++m) {
      double sum = 0;
      for (int n = -l; n <= l; ++n) {
        sum += at(l, m, n) * double{from[static_cast<std::size_t>(coefficient_index(l, n))]};
      }
      to[static_cast<std::size_t>(coefficient_index(l, m))] = static_cast<float>(sum);
    }
  }
}

}  // namespace prt::sh
