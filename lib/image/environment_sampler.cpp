#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/environment.h"

namespace prt::image {

namespace {

using std::numbers::pi;

double luminance(const float* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// Mean luminance of a texel and its neighbours: bilinear radiance inside a texel depends on just
// these, so that no direction with radiance has density 0.
double smoothed_luminance(const Image& map, int x, int y) {
  double sum = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    const int row = std::clamp(y + dy, 0, map.height - 1);
    for (int dx = -1; dx <= 1; ++dx) {
      sum += luminance(map.at((x + dx + map.width) % map.width, row));
    }
  }
  return sum / 9;
}

double row_edge_height(int row, int row_count) { return std::cos(pi * row / row_count); }

// Makes a distribution of the running sums: 0 … 1. A sum of 0 becomes uniform.
void normalise(double* cdf, int count) {
  const double total = cdf[count];
  for (int i = 0; i < count; ++i) cdf[i] = total > 0 ? cdf[i] / total : double(i) / count;
  cdf[count] = 1;
}

// The interval that holds `u`, never one of probability 0.
int find(const double* cdf, int count, double u) {
  const int i = static_cast<int>(std::upper_bound(cdf, cdf + count + 1, u) - cdf) - 1;
  return std::clamp(i, 0, count - 1);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Image& environment)
    : width_(environment.width),
      height_(environment.height),
      row_cdf_(static_cast<std::size_t>(height_) + 1),
      column_cdf_(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1)) {
  for (int y = 0; y < height_; ++y) {
    double* cdf = column_cdf_.data() + (columns(y) - column_cdf_.data());
    for (int x = 0; x < width_; ++x) cdf[x + 1] = cdf[x] + smoothed_luminance(environment, x, y);
    const double row_solid_angle = row_edge_height(y, height_) - row_edge_height(y + 1, height_);
    const auto row = static_cast<std::size_t>(y);
    row_cdf_[row + 1] = row_cdf_[row] + cdf[width_] * row_solid_angle;
    normalise(cdf, width_);
  }
  if (row_cdf_.back() == 0) {  // a black map: any direction
    for (int y = 0; y <= height_; ++y) {
      row_cdf_[static_cast<std::size_t>(y)] = 1 - row_edge_height(y, height_);
    }
  }
  normalise(row_cdf_.data(), height_);
}

EnvironmentSampler::Sample EnvironmentSampler::sample(float u0, float u1) const {
  const int y = find(row_cdf_.data(), height_, u0);
  const double* rows = row_cdf_.data() + y;
  const double* cells = columns(y);
  const int x = find(cells, width_, u1);
  const double row_fraction = std::min((u0 - rows[0]) / (rows[1] - rows[0]), 1.0);
  const double column_fraction = std::min((u1 - cells[x]) / (cells[x + 1] - cells[x]), 1.0);
  const double top = row_edge_height(y, height_), bottom = row_edge_height(y + 1, height_);
  const double height = top + row_fraction * (bottom - top);
  const double radius = std::sqrt(std::max(0.0, 1 - height * height));
  const double longitude = pi * (1 - 2 * (x + column_fraction) / width_);
  return {Vec3(static_cast<float>(std::sin(longitude) * radius), static_cast<float>(height),
               static_cast<float>(std::cos(longitude) * radius)),
          texel_pdf(x, y)};
}

float EnvironmentSampler::pdf(const Vec3& direction) const {
  const Vec2 uv = latlong_from_direction(direction);
  const int x = static_cast<int>(uv.x * static_cast<float>(width_));
  const int y = static_cast<int>(uv.y * static_cast<float>(height_));
  return texel_pdf(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1));
}

float EnvironmentSampler::texel_pdf(int x, int y) const {
  const double* rows = row_cdf_.data() + y;
  const double* cells = columns(y);
  const double solid_angle =
      2 * pi / width_ * (row_edge_height(y, height_) - row_edge_height(y + 1, height_));
  return static_cast<float>((rows[1] - rows[0]) * (cells[x + 1] - cells[x]) / solid_angle);
}

const double* EnvironmentSampler::columns(int y) const {
  return column_cdf_.data() + static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1);
}

}  // namespace prt::image
