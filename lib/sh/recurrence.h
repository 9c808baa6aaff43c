// The recurrences behind the basis, for one scalar or one vector of lanes per coordinate.
//
// With the azimuth's cos(m phi) sin(theta)^m = Re (x + i y)^m and the sine its imaginary part, what
// is left of Y(l, ±m) is a polynomial q(l,m) of z that holds all factors (normalisation, sqrt 2,
// the phase (-1)^m):
//   q(m,m)   constant
//   q(l,m) = a(l,m) z q(l-1,m) - c(l,m) q(l-2,m)
//   a(l,m) = sqrt((4l²-1) / (l²-m²)),  c(l,m) = a(l,m) / a(l-1,m)
// which is stable upwards in l.
#pragma once

#include <array>
#include <numbers>

#include "sh/basis.h"

namespace prt::sh {

/// Square root at compile time: Newton's iteration, monotone from above.
constexpr double constexpr_sqrt(double x) {
  double root = x > 1 ? x : 1;
  for (double next = (root + x / root) / 2; next < root; next = (root + x / root) / 2) root = next;
  return root;
}

struct RecurrenceTable {
  using Triangle = std::array<std::array<double, kMaxBandCount>, kMaxBandCount>;
  std::array<double, kMaxBandCount> start{};  ///< q(m,m)
  Triangle a{}, c{};                          ///< [l][m], l > m; c(m+1,m) is 0
};

constexpr RecurrenceTable make_recurrence_table() {
  RecurrenceTable table;
  double square = 1 / (4 * std::numbers::pi);
  for (int m = 0; m < kMaxBandCount; ++m) {
    const auto column = static_cast<std::size_t>(m);
    if (m > 0) square *= (2 * m + 1) / (2.0 * m);
    table.start[column] = (m % 2 ? -1 : 1) * constexpr_sqrt(m > 0 ? 2 * square : square);
    for (int l = m + 1; l < kMaxBandCount; ++l) {
      const auto row = static_cast<std::size_t>(l);
      table.a[row][column] = constexpr_sqrt((4.0 * l * l - 1) / (l * l - m * m));
      if (l > m + 1) table.c[row][column] = table.a[row][column] / table.a[row - 1][column];
    }
  }
  return table;
}

inline constexpr RecurrenceTable kRecurrence = make_recurrence_table();

/// Calls store(index, value) for every coefficient. Real is the type of the constants, Lanes that
/// of the coordinates; both may be the same.
template <class Real, class Lanes, class Store>
[[gnu::always_inline]] inline void evaluate_lanes(int band_count, Lanes x, Lanes y, Lanes z,
                                                  const Store& store) {
  Lanes cosine = z - z + Real(1), sine = z - z;  // Re and Im (x + i y)^m
  for (int m = 0; m < band_count; ++m) {
    const auto column = static_cast<std::size_t>(m);
    Lanes before = z - z, q = before + static_cast<Real>(kRecurrence.start[column]);
    for (int l = m; l < band_count; ++l) {
      if (l > m) {
        const auto row = static_cast<std::size_t>(l);
        const Lanes next = static_cast<Real>(kRecurrence.a[row][column]) * z * q -
                           static_cast<Real>(kRecurrence.c[row][column]) * before;
        before = q;
        q = next;
      }
      store(coefficient_index(l, m), q * cosine);
      if (m > 0) store(coefficient_index(l, -m), q * sine);
    }
    const Lanes next_cosine = x * cosine - y * sine;
    sine = x * sine + y * cosine;
    cosine = next_cosine;
  }
}

}  // namespace prt::sh
