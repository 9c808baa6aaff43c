#include "runtime/hemisphere_map.h"

#include <cassert>
#include <cstddef>

#include "sh/basis.h"

namespace prt::runtime {

namespace {

// Ends of the spline far outside the map: their influence falls to 0.27 of itself at every texel.
constexpr int kMargin = 10;
constexpr std::size_t kGridSize = kHemisphereMapSize + 2 * kMargin;

/// Control points of the cubic B-spline through `count` values `stride` apart, in their place:
/// solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = value[i] with c[-1] = c[0] and c[count] = c[count - 1].
void to_control_points(double* values, std::size_t count, std::size_t stride) {
  std::vector<double> factor(count);
  factor[0] = 5.0;
  values[0] *= 6.0;
  for (std::size_t i = 1; i < count; ++i) {
    factor[i] = (i + 1 < count ? 4.0 : 5.0) - 1.0 / factor[i - 1];
    values[i * stride] = 6.0 * values[i * stride] - values[(i - 1) * stride] / factor[i - 1];
  }
  values[(count - 1) * stride] /= factor[count - 1];
  for (std::size_t i = count - 1; i-- > 0;)
    values[i * stride] = (values[i * stride] - values[(i + 1) * stride]) / factor[i];
}

/// Functions of all bands at the grid's points, which go on outside the rim: grid after grid.
std::vector<double> functions_on_grid(int band_count) {
  const auto count = static_cast<std::size_t>(sh::coefficient_count(band_count));
  std::vector<double> values(count * kGridSize * kGridSize), at_point(count);
  const auto coordinate = [](std::size_t i) {
    return 2.0 * (static_cast<double>(i) - kMargin - 1) / (kHemisphereMapSize - 3) - 1.0;
  };
  for (std::size_t j = 0; j < kGridSize; ++j)
    for (std::size_t i = 0; i < kGridSize; ++i) {
      const double p = coordinate(i), q = coordinate(j), r = p * p + q * q;
      sh::evaluate(band_count, 2 * p / (1 + r), 2 * q / (1 + r), (1 - r) / (1 + r), at_point);
      for (std::size_t k = 0; k < count; ++k)
        values[(k * kGridSize + j) * kGridSize + i] = at_point[k];
    }
  return values;
}

}  // namespace

std::vector<Vec4> hemisphere_map(const ExitLayout& layout) {
  assert(layout.is_glossy());
  constexpr std::size_t kSize = kHemisphereMapSize;
  std::vector<double> grids = functions_on_grid(layout.band_count);
  std::vector<Vec4> texels(layout.color_vector_count() * kSize * kSize, Vec4(0.0f));
  for (std::size_t slot = 0; slot < layout.row_of_slot.size(); ++slot) {
    const auto row = static_cast<std::size_t>(layout.row_of_slot[slot]);
    double* const grid =
        &grids[static_cast<std::size_t>(layout.functions[row]) * kGridSize * kGridSize];
    for (std::size_t i = 0; i < kGridSize; ++i) to_control_points(grid + i, kGridSize, kGridSize);
    for (std::size_t j = 0; j < kGridSize; ++j)
      to_control_points(grid + j * kGridSize, kGridSize, 1);
    for (std::size_t j = 0; j < kSize; ++j)
      for (std::size_t i = 0; i < kSize; ++i)
        texels[(slot / 4 * kSize + j) * kSize + i][static_cast<int>(slot % 4)] =
            static_cast<float>(grid[(j + kMargin) * kGridSize + i + kMargin]);
  }
  return texels;
}

}  // namespace prt::runtime
