#include "sh/hemisphere.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/error.h"
#include "linalg/decompose.h"
#include "linalg/product.h"
#include "sh/basis.h"
#include "sh/quadrature.h"

namespace prt::sh {

namespace {

using linalg::MatrixD;
using linalg::Transpose;

int degree_of(int function) { return static_cast<int>(std::sqrt(function + 0.5)); }
int order_of(int function) {
  const int l = degree_of(function);
  return function - coefficient_index(l, 0);
}
bool is_even(int function) { return (degree_of(function) + order_of(function)) % 2 == 0; }

MatrixD square(std::vector<double>& values, std::size_t size) {
  return {values.data(), size, size};
}

// Symmetric eigenvalue problem of A among functions of one order m: adds V max(Λ)⁻¹ Vᵀ to the
// places of these functions in P.
void add_inverse(std::span<const int> functions, std::span<const std::size_t> places,
                 double minimum_eigenvalue, std::vector<double>& projection) {
  std::vector<int> block;
  for (const std::size_t place : places) block.push_back(functions[place]);
  std::vector<double> gram = hemisphere_gram(block, block);
  const std::size_t size = block.size();
  const auto pairs = linalg::largest_eigenpairs(square(gram, size), size);
  for (std::size_t k = 0; k < size && pairs.values[k] >= minimum_eigenvalue; ++k) {
    const double* vector = &pairs.vectors[k * size];
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        projection[places[i] * functions.size() + places[j]] +=
            vector[i] * vector[j] / pairs.values[k];
      }
    }
  }
}

std::vector<double> least_squares(std::span<const int> functions, double minimum_eigenvalue) {
  std::vector<double> projection(functions.size() * functions.size());
  const int last = band_count_of(functions) - 1;
  for (int m = -last; m <= last; ++m) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < functions.size(); ++i) {
      if (order_of(functions[i]) == m) places.push_back(i);
    }
    if (!places.empty()) add_inverse(functions, places, minimum_eigenvalue, projection);
  }
  return projection;
}

}  // namespace

std::vector<int> hemisphere_functions(int count) {
  const int band_count = static_cast<int>(std::lround(std::sqrt(count + 0.5)));
  const bool all = count == band_count * band_count;
  const bool all_but_one = band_count >= 2 && count == band_count * band_count - 1;
  if (count < 1 || band_count > kMaxBandCount || (!all && !all_but_one)) {
    throw Error(
        ErrorKind::usage, "no set of hemispherical functions has this size",
        {.found = std::to_string(count), .expected = "n² or n² - 1 for n bands: 24, 25, …"});
  }
  std::vector<int> functions;
  for (int i = 0; i < band_count * band_count; ++i) {
    if (all || i != coefficient_index(1, 0)) functions.push_back(i);
  }
  return functions;
}

int band_count_of(std::span<const int> functions) {
  return functions.empty() ? 0
                           : degree_of(*std::max_element(functions.begin(), functions.end())) + 1;
}

// Functions of different order are orthogonal on H too. Of one order, the product is a polynomial
// in z, which the Gauss rule integrates exactly over [0, 1]; its mean over the azimuth is half its
// value where the cosine (or sine) is 1, or all of it for m = 0.
std::vector<double> hemisphere_gram(std::span<const int> rows, std::span<const int> columns) {
  const int band_count = std::max(band_count_of(rows), band_count_of(columns));
  const GaussLegendre rule(band_count);
  std::vector<double> gram(rows.size() * columns.size());
  std::vector<double> values(row_size(band_count));
  const auto value = [&](int function) {
    const int l = degree_of(function);
    return values[static_cast<std::size_t>(coefficient_index(l, std::abs(order_of(function))))];
  };
  for (std::size_t n = 0; n < rule.nodes.size(); ++n) {
    const double z = (rule.nodes[n] + 1) / 2;
    evaluate(band_count, std::sqrt(1 - z * z), 0.0, z, values);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int m = order_of(rows[i]);
      const double weight = rule.weights[n] / 2 * std::numbers::pi * (m == 0 ? 2 : 1);
      for (std::size_t j = 0; j < columns.size(); ++j) {
        if (order_of(columns[j]) != m) continue;
        gram[i * columns.size() + j] += weight * value(rows[i]) * value(columns[j]);
      }
    }
  }
  return gram;
}

std::vector<double> hemisphere_projection(HemisphereProjection kind, std::span<const int> functions,
                                          double minimum_eigenvalue) {
  assert(minimum_eigenvalue > 0);
  if (kind == HemisphereProjection::least_squares) {
    return least_squares(functions, minimum_eigenvalue);
  }
  std::vector<double> projection(functions.size() * functions.size());
  for (std::size_t i = 0; i < functions.size(); ++i) {
    double scale = 1;
    if (kind == HemisphereProjection::odd_reflection) scale = is_even(functions[i]) ? 0 : 2;
    if (kind == HemisphereProjection::even_reflection) scale = is_even(functions[i]) ? 2 : 0;
    projection[i * functions.size() + i] = scale;
  }
  return projection;
}

HemisphereError hemisphere_error(HemisphereProjection kind, std::span<const int> functions,
                                 int signal_band_count) {
  const auto signal_size = row_size(signal_band_count);
  const int band_count = std::max(signal_band_count, band_count_of(functions));
  const std::vector<int> all = hemisphere_functions(coefficient_count(band_count));
  const std::vector<int> signal = hemisphere_functions(coefficient_count(signal_band_count));
  std::vector<double> gram = hemisphere_gram(all, all);
  std::vector<double> moments = hemisphere_gram(functions, signal);
  std::vector<double> projection = hemisphere_projection(kind, functions);
  std::vector<double> coefficients(functions.size() * signal_size);
  const MatrixD c(coefficients.data(), functions.size(), signal_size);
  linalg::gemm(1, square(projection, functions.size()), Transpose::no,
               MatrixD(moments.data(), functions.size(), signal_size), Transpose::no, 0, c);
  std::vector<double> difference(all.size() * signal_size);  // P A - I
  for (std::size_t i = 0; i < functions.size(); ++i) {
    std::copy_n(c.row(i), signal_size,
                &difference[static_cast<std::size_t>(functions[i]) * signal_size]);
  }
  for (std::size_t i = 0; i < signal_size; ++i) difference[i * signal_size + i] -= 1;
  const MatrixD d(difference.data(), all.size(), signal_size);
  std::vector<double> product(all.size() * signal_size), quadric(signal_size * signal_size);
  const MatrixD ad(product.data(), all.size(), signal_size), q = square(quadric, signal_size);
  linalg::gemm(1, square(gram, all.size()), Transpose::no, d, Transpose::no, 0, ad);
  linalg::gemm(1, d, Transpose::yes, ad, Transpose::no, 0, q);
  const auto pairs = linalg::largest_eigenpairs(q, signal_size);
  HemisphereError error{pairs.values.front(), 0};
  for (const double value : pairs.values) error.mean += value / static_cast<double>(signal_size);
  return error;
}

// The Schur complement of the others in A: what of the function is orthogonal to them.
double dropping_error(std::span<const int> functions, int dropped) {
  std::vector<int> others(functions.begin(), functions.end());
  std::erase(others, dropped);
  const int one[] = {dropped};
  const std::vector<double> moments = hemisphere_gram(others, one);
  const auto inverse = hemisphere_projection(HemisphereProjection::least_squares, others, 1e-14);
  double error = hemisphere_gram(one, one)[0];
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (std::size_t j = 0; j < others.size(); ++j) {
      error -= moments[i] * inverse[i * others.size() + j] * moments[j];
    }
  }
  return error;
}

}  // namespace prt::sh
