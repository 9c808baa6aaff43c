#include "brdf/brdf_matrix.h"

#include <algorithm>
#include <cmath>

#include "core/log.h"
#include "linalg/product.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::brdf {

namespace {

using linalg::MatrixD;
using linalg::Transpose;

/// tr(P_r B P_c Bᵀ): the energy of a kernel with moments B within the bands; P_c = I sums exit
/// radiance over unit lights.
double captured(const std::vector<double>& b, std::vector<double> p_rows,
                std::vector<double> p_columns) {
  const auto rows = static_cast<std::size_t>(std::lround(std::sqrt(p_rows.size())));
  const std::size_t columns = b.size() / rows;
  std::vector<double> left(b.size()), both(b.size());
  const linalg::ConstMatrixD matrix(b.data(), rows, columns);
  linalg::gemm(1, MatrixD(p_rows.data(), rows, rows), Transpose::no, matrix, Transpose::no, 0,
               MatrixD(left.data(), rows, columns));
  linalg::gemm(1, MatrixD(left.data(), rows, columns), Transpose::no,
               MatrixD(p_columns.data(), columns, columns), Transpose::no, 0,
               MatrixD(both.data(), rows, columns));
  double sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i) sum += both[i] * b[i];
  return sum;
}

struct Energies {
  double exit, kernel;
};

Energies captured_energies(const std::vector<double>& b, int row_band_count,
                           int column_band_count) {
  const auto projection = [](sh::HemisphereProjection kind, int band_count) {
    return sh::hemisphere_projection(kind,
                                     sh::hemisphere_functions(sh::coefficient_count(band_count)));
  };
  const auto rows = projection(sh::HemisphereProjection::least_squares, row_band_count);
  return {
      captured(b, rows, projection(sh::HemisphereProjection::zero_hemisphere, column_band_count)),
      captured(b, rows, projection(sh::HemisphereProjection::least_squares, column_band_count))};
}

/// y_lm(φ + angle) = cos(m angle) y_lm - sin(m angle) y_l-m, y_l-m(φ + angle) = sin(…) y_lm +
/// cos(…) y_l-m: turns the coefficients at `values` (stride apart) of a function turned by the
/// angle.
void turn_about_z(double angle, int band_count, std::size_t stride, double* values) {
  for (int l = 1; l < band_count; ++l) {
    for (int m = 1; m <= l; ++m) {
      double& a = values[static_cast<std::size_t>(sh::coefficient_index(l, m)) * stride];
      double& b = values[static_cast<std::size_t>(sh::coefficient_index(l, -m)) * stride];
      const double c = std::cos(m * angle), s = std::sin(m * angle), before = a;
      a = c * a - s * b;
      b = s * before + c * b;
    }
  }
}

void turn(double angle, int row_band_count, int column_band_count, std::vector<double>& b) {
  if (angle == 0) return;
  const std::size_t column_count = sh::row_size(column_band_count);
  for (std::size_t j = 0; j < column_count; ++j) {
    turn_about_z(angle, row_band_count, column_count, &b[j]);
  }
  for (std::size_t i = 0; i < sh::row_size(row_band_count); ++i) {
    turn_about_z(angle, column_band_count, 1, &b[i * column_count]);
  }
}

double share(double lost, double kept) { return lost > 0 ? lost / (lost + kept) : 0; }

}  // namespace

// What the bands lose of a sum has at most the norm of the lobes' losses together.
BrdfMatrix brdf_matrix(const Brdf& brdf, int row_band_count, int column_band_count,
                       double tolerance, const std::filesystem::path& folder) {
  BrdfMatrix result{row_band_count, column_band_count, {}, 0, {}};
  const std::size_t size = sh::row_size(row_band_count) * sh::row_size(column_band_count);
  std::vector<double> mean(size);
  result.channels.fill(mean);
  double exit_norm = 0, kernel_norm = 0;
  for (const auto& [colour, lobe] : brdf.lobes) {
    const LobeMatrix matrix =
        cached_lobe_matrix(*lobe, row_band_count, column_band_count, tolerance, folder);
    const double weight = (colour.x + colour.y + colour.z) / 3;
    for (std::size_t i = 0; i < size; ++i) {
      mean[i] += weight * matrix.values[i];
      for (int c = 0; c < 3; ++c) {
        result.channels[static_cast<std::size_t>(c)][i] += colour[c] * matrix.values[i];
      }
    }
    const Energies kept = captured_energies(matrix.values, row_band_count, column_band_count);
    exit_norm += weight * std::sqrt(std::max(0.0, matrix.exit_energy - kept.exit));
    kernel_norm += weight * std::sqrt(std::max(0.0, matrix.kernel_energy - kept.kernel));
    result.error += matrix.error * std::max({colour.x, colour.y, colour.z});
  }
  const Energies kept = captured_energies(mean, row_band_count, column_band_count);
  result.loss = {share(exit_norm * exit_norm, kept.exit),
                 share(kernel_norm * kernel_norm, kept.kernel)};
  for (auto& channel : result.channels) {
    turn(brdf.rotation, row_band_count, column_band_count, channel);
  }
  return result;
}

void warn_of_losses(const BrdfMatrix& matrix, const std::string& name, double tolerance) {
  // A sum of kMaterialLobeCount lobes may have the error of each.
  if (matrix.error > static_cast<double>(kMaterialLobeCount) * tolerance) {
    log::warning("{}: BRDF matrix accurate to {:.1e} only", name, matrix.error);
  }
  if (matrix.loss.exit > kSharpExitLoss || matrix.loss.kernel > kSharpKernelLoss) {
    log::warning(
        "{}: too sharp for {} and {} bands: {:.2g}% of the energy of its answer to light of these "
        "bands is lost, {:.0f}% of that to unlimited light",
        name, matrix.row_band_count, matrix.column_band_count, 100 * matrix.loss.exit,
        100 * matrix.loss.kernel);
  }
}

}  // namespace prt::brdf
