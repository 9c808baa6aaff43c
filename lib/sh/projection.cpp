#include "sh/projection.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "sh/basis.h"
#include "sh/light.h"
#include "sh/quadrature.h"

namespace prt::sh {

namespace {

using std::numbers::pi;
constexpr std::size_t kRowsPerBlock = 8;

// Integrals of cos(m phi), m = 0 … bands-1, then sin(m phi), m = 1 … bands-1, over each column;
// column i spans the longitudes from pi (1 - 2 (i+1) / width) to pi (1 - 2 i / width).
std::vector<double> longitude_integrals(int band_count, int width) {
  std::vector<double> table;
  table.reserve(static_cast<std::size_t>(2 * band_count - 1) * static_cast<std::size_t>(width));
  const double half_step = pi / width;
  for (int k = 0; k < 2 * band_count - 1; ++k) {
    const int m = k < band_count ? k : k - band_count + 1;
    const double weight = m == 0 ? 2 * half_step : 2 * std::sin(m * half_step) / m;
    for (int i = 0; i < width; ++i) {
      const double centre = m * (pi - (2 * i + 1) * half_step);
      table.push_back(weight * (k < band_count ? std::cos(centre) : std::sin(centre)));
    }
  }
  return table;
}

// Integrals over a row's latitudes of Y(l,m) at azimuth 0 about the zenith, m >= 0, at
// coefficient_index(l, m). Pieces no taller than pi/32 make eight Gauss nodes exact to double
// precision for all bands.
class LatitudeIntegrals {
 public:
  LatitudeIntegrals(int band_count, int height)
      : band_count_(band_count), height_(height), piece_count_((32 + height - 1) / height) {}

  void row(int y, std::vector<double>& sums) const {
    std::vector<double> values(sums.size());
    std::fill(sums.begin(), sums.end(), 0.0);
    const double size = pi / height_ / piece_count_;
    for (int piece = 0; piece < piece_count_; ++piece) {
      for (std::size_t k = 0; k < rule_.nodes.size(); ++k) {
        const double theta =
            (y * piece_count_ + piece + 0.5 * (1 + rule_.nodes[k])) * size;  // from the zenith
        evaluate(band_count_, std::sin(theta), 0.0, std::cos(theta), values);
        const double weight = 0.5 * size * rule_.weights[k] * std::sin(theta);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * values[i];
      }
    }
  }

 private:
  int band_count_, height_, piece_count_;
  GaussLegendre rule_{8};
};

// Eight partial sums, so that the loop is a vector one.
double dot(const double* a, const double* b, std::size_t count) {
  std::array<double, 8> sums{};
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    for (std::size_t k = 0; k < 8; ++k) sums[k] += a[i + k] * b[i + k];
  }
  for (; i < count; ++i) sums[0] += a[i] * b[i];
  double sum = 0;
  for (double part : sums) sum += part;
  return sum;
}

using Sums = std::array<std::vector<double>, 3>;  // per channel: coefficients about the zenith

// Adds rows [begin, end): Fourier sums along each, then the Legendre part.
void add_rows(int band_count, int width, const float* rgb, const std::vector<double>& longitudes,
              const LatitudeIntegrals& latitudes, std::size_t begin, std::size_t end, Sums& sums) {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<double> texels(columns), fourier(static_cast<std::size_t>(2 * band_count - 1));
  std::vector<double> legendre(sums[0].size());
  for (std::size_t y = begin; y < end; ++y) {
    latitudes.row(static_cast<int>(y), legendre);
    for (std::size_t c = 0; c < 3; ++c) {
      const float* row = rgb + 3 * y * columns + c;
      for (std::size_t x = 0; x < columns; ++x) texels[x] = double{row[3 * x]};
      for (std::size_t k = 0; k < fourier.size(); ++k) {
        fourier[k] = dot(texels.data(), longitudes.data() + k * columns, columns);
      }
      for (int l = 0; l < band_count; ++l) {
        for (int m = -l; m <= l; ++m) {
          const int wave = m >= 0 ? m : band_count - 1 - m;
          sums[c][static_cast<std::size_t>(coefficient_index(l, m))] +=
              fourier[static_cast<std::size_t>(wave)] *
              legendre[static_cast<std::size_t>(coefficient_index(l, std::abs(m)))];
        }
      }
    }
  }
}

}  // namespace

Light project_environment(int band_count, int width, int height, const float* rgb) {
  assert(band_count >= 1 && band_count <= kMaxBandCount && width > 0 && height > 0);
  const std::vector<double> longitudes = longitude_integrals(band_count, width);
  const LatitudeIntegrals latitudes(band_count, height);
  const auto row_count = static_cast<std::size_t>(height);
  const auto value_count = row_size(band_count);
  Sums zero;
  zero.fill(std::vector<double>(value_count));
  std::vector<Sums> blocks(block_count(row_count, kRowsPerBlock), zero);
  parallel_for(row_count, kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
    add_rows(band_count, width, rgb, longitudes, latitudes, begin, end,
             blocks[begin / kRowsPerBlock]);
  });
  Light light(band_count);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < value_count; ++i) {
      double sum = 0;
      for (const Sums& block : blocks) sum += block[c][i];
      light.coefficients[c][i] = static_cast<float>(sum);
    }
  }
  // The map's frame has its zenith along its z and longitude 0 along its x: world's Y and Z.
  const Matrix4 world_from_map(0, 0, 1, 0,  //
                               1, 0, 0, 0,  //
                               0, 1, 0, 0,  //
                               0, 0, 0, 1);
  return rotated(light, world_from_map);
}

double texel_solid_angle(int width, int height, int row) {
  return 4 * pi / width * std::sin(pi * (row + 0.5) / height) * std::sin(pi / (2.0 * height));
}

std::array<double, 3> environment_energy(int width, int height, const float* rgb) {
  std::array<double, 3> energy{};
  for (int y = 0; y < height; ++y) {
    std::array<double, 3> row{};
    for (int x = 0; x < width; ++x, rgb += 3) {
      for (std::size_t c = 0; c < 3; ++c) row[c] += double{rgb[c]} * double{rgb[c]};
    }
    for (std::size_t c = 0; c < 3; ++c) energy[c] += row[c] * texel_solid_angle(width, height, y);
  }
  return energy;
}

}  // namespace prt::sh
