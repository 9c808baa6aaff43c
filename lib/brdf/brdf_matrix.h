// A whole reflection model as SH matrices, one a colour channel, and how much of it the bands hold.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "brdf/brdf.h"
#include "brdf/matrix_cache.h"

namespace prt::brdf {

/// Energy (squared norm) that least squares projection onto the bands loses, as a share of all of
/// it: exact for one lobe, for several an upper bound.
struct BandLoss {
  /// Of exit radiance over H under all light of the incident bands: what the rows cannot show.
  double exit = 0;
  /// Of the kernel f s_z over H × H: also what light of higher bands would have added.
  double kernel = 0;
};

/// Losses from here on are worth a warning: of `exit`, a tenth of the radiance (RMS) in light of
/// these bands; of `kernel`, nearly all that makes the reflection of a brighter detail sharp.
constexpr double kSharpExitLoss = 0.01, kSharpKernelLoss = 0.9;

struct BrdfMatrix {
  int row_band_count = 0;
  int column_band_count = 0;
  /// B of brdf/lobe_matrix.h for red, green and blue, in the frame of normal and tangent.
  std::array<std::vector<double>, 3> channels;
  double error = 0;  ///< estimated bound of an entry's absolute error
  BandLoss loss;     ///< of the mean of the channels
};

/// Sums the lobes' matrices, which are taken from the cache folder or put there.
BrdfMatrix brdf_matrix(const Brdf& brdf, int row_band_count, int column_band_count,
                       double tolerance = kMatrixTolerance,
                       const std::filesystem::path& folder = default_cache_folder());

/// Warns, with the figures, when a loss is above kSharpExitLoss or kSharpKernelLoss, and when the
/// quadrature missed the tolerance. `name` is the material's, for the message.
void warn_of_losses(const BrdfMatrix& matrix, const std::string& name,
                    double tolerance = kMatrixTolerance);

}  // namespace prt::brdf
