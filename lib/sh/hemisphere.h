// Functions over the upper hemisphere H (z >= 0) as sums of SH functions, which are not orthogonal
// there: the appendix of [Sloan03].
//
// The moments of f are b_i = ∫_H f y_i; coefficients c approximate f ≈ Σ_i c_i y_i on H. Every
// projection here is a linear map P from moments to coefficients, c = P b. Which functions take
// part is a list of coefficient indices. A function is even when y(x,y,-z) = y(x,y,z), which is
// when l+m is even, and odd otherwise; the paper's two equations for this are swapped, its counts
// and errors are not.
#pragma once

#include <span>
#include <vector>

namespace prt::sh {

/// `count` = n²: all functions of n bands. n² - 1, n >= 2: all but l = 1, m = 0, which the others
/// very nearly replace on H (for n = 5 to a squared error of 1.48e-5). Throws Error (usage) for
/// other counts.
std::vector<int> hemisphere_functions(int count);

/// Bands that hold these functions.
int band_count_of(std::span<const int> functions);

/// A_ij = ∫_H y_rows[i] y_columns[j], exact up to rounding; rows.size() × columns.size() values,
/// row by row.
std::vector<double> hemisphere_gram(std::span<const int> rows, std::span<const int> columns);

enum class HemisphereProjection {
  least_squares,    ///< P = A⁻¹: the least squared error on H
  zero_hemisphere,  ///< P = I: f continued by 0
  odd_reflection,   ///< f continued by -f(x,y,-z): 2 for odd functions, 0 for even ones
  even_reflection   ///< f continued by f(x,y,-z): 2 for even functions, 0 for odd ones
};

/// Smallest eigenvalue of A that is inverted. A function of unit norm on H has coefficients of at
/// most 1 / sqrt of it, here 1000, so that float coefficients cost it less than 1e-4. Five bands
/// (6.59e-6) are inverted exactly; more bands lose the functions that are nearly 0 on H.
constexpr double kMinimumEigenvalue = 1e-6;

/// P of a projection: functions.size()² values, symmetric, 0 between functions of different m.
/// Least squares leaves out eigenvectors of A below `minimum_eigenvalue` (the minimum norm
/// solution), so that P is bounded by its inverse however many bands there are.
std::vector<double> hemisphere_projection(HemisphereProjection kind, std::span<const int> functions,
                                          double minimum_eigenvalue = kMinimumEigenvalue);

/// Squared error on H over all sums of `signal_band_count` bands of unit length: the extreme and
/// mean eigenvalues of (PA - I)ᵀ A (PA - I) [Sloan03] §9.2.
struct HemisphereError {
  double worst = 0, mean = 0;
};
HemisphereError hemisphere_error(HemisphereProjection kind, std::span<const int> functions,
                                 int signal_band_count);

/// Squared error on H of function `dropped` when the other `functions` stand for it.
double dropping_error(std::span<const int> functions, int dropped);

}  // namespace prt::sh
