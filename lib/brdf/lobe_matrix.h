// A lobe as a linear operator on SH coefficients over the upper hemisphere H: [Sloan03] §3.1,
// [Kautz02]. By adaptive quadrature, to an error that it estimates.
#pragma once

#include <vector>

#include "brdf/lobe.h"

namespace prt::brdf {

/// Default absolute error of the entries of B.
constexpr double kMatrixTolerance = 1e-5;

/// B_ij = ∫_H ∫_H y_i(v) y_j(s) f(s, v) s_z ds dv: from coefficients of incident radiance to
/// moments of exit radiance, both in the lobe's frame.
struct LobeMatrix {
  int row_band_count = 0;      ///< of exit radiance
  int column_band_count = 0;   ///< of incident radiance
  std::vector<double> values;  ///< row_band_count² × column_band_count², row by row
  double error = 0;            ///< estimated bound of an entry's absolute error
  double exit_energy = 0;  ///< Σ_j ∫_H (∫_H y_j(s) f s_z ds)² dv: all that leaves, of any band
  double kernel_energy = 0;  ///< ∫_H ∫_H (f s_z)² ds dv
};

/// 1 to sh::kMaxBandCount bands each; all processors. At the default tolerance and five bands each
/// it takes below 0.2 s of isotropic lobes and some seconds of anisotropic ones, however sharp.
/// `error` is above the tolerance where the quadrature gave up.
LobeMatrix compute_lobe_matrix(const Lobe& lobe, int row_band_count, int column_band_count,
                               double tolerance = kMatrixTolerance);

/// ∫_H y_j(s) f(s, eye) s_z ds for the coefficients of `band_count` bands, and last the integral of
/// (f s_z)²: radiance towards the eye under each function as light.
struct LobeMoments {
  std::vector<double> values;
  double error = 0;  ///< estimated, of all but the last
};
LobeMoments lobe_moments(const Lobe& lobe, const Direction& eye, int band_count, double tolerance);

/// Share of light from all sides that is reflected towards the eye; by reciprocity also the share
/// of light from there that is reflected at all.
double directional_albedo(const Lobe& lobe, const Direction& eye, double tolerance = 1e-6);

}  // namespace prt::brdf
