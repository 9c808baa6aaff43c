#include "runtime/view_basis.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sh/recurrence.h"

namespace prt::runtime {

namespace {

/// By Horner's rule in z².
std::string polynomial_text(int l, int m) {
  const std::vector<double> factors = polynomial_of_z(l, m);
  std::string text = fmt::format("{:#.9g}", factors.back());
  for (std::size_t i = factors.size() - 1; i >= 2; i -= 2)
    text = fmt::format("({:#.9g} + zz * {})", factors[i - 2], text);
  return factors.size() % 2 == 0 ? "z * " + text : text;
}

}  // namespace

std::vector<double> polynomial_of_z(int l, int m) {
  const auto column = static_cast<std::size_t>(m);
  std::vector<double> before, q{sh::kRecurrence.start[column]};
  for (auto row = column + 1; row <= static_cast<std::size_t>(l); ++row) {
    std::vector<double> next(q.size() + 1, 0.0);
    for (std::size_t i = 0; i < q.size(); ++i) next[i + 1] = sh::kRecurrence.a[row][column] * q[i];
    for (std::size_t i = 0; i < before.size(); ++i)
      next[i] -= sh::kRecurrence.c[row][column] * before[i];
    before = std::exchange(q, std::move(next));
  }
  return q;
}

std::string basis_polynomials(const ExitLayout& layout) {
  assert(layout.is_glossy());
  std::string text;
  for (std::size_t slot = 0; slot < layout.slot_count(); ++slot) {
    text += slot % 4 == 0 ? fmt::format("F({}, vec4(", slot / 4) : ", ";
    const int m = layout.order_of_pair[slot / 2];
    if (slot >= layout.row_of_slot.size()) {
      text += "0.0";
    } else {
      const auto row = static_cast<std::size_t>(layout.row_of_slot[slot]);
      const int l = static_cast<int>(std::sqrt(layout.functions[row] + 0.5));
      text += polynomial_text(l, m);
      if (m > 0) {  // the next slot's too
        text += fmt::format(" * p[{}]", m);
        ++slot;
      }
    }
    if (slot % 4 == 3) text += ")) ";
  }
  return text;
}

}  // namespace prt::runtime
