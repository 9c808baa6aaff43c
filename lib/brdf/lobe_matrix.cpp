#include "brdf/lobe_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "brdf/cubature.h"
#include "brdf/half_vector.h"
#include "brdf/slope_domain.h"
#include "core/parallel.h"
#include "sh/basis.h"

namespace prt::brdf {

namespace {

Direction direction(const Point& angles) {
  const double s = std::sin(angles.x);
  return {s * std::cos(angles.y), s * std::sin(angles.y), std::cos(angles.x)};
}

// Cuts of [low, high] at the peak and at distances growing from it, so that no rule of 15 nodes
// steps over a narrow peak.
std::vector<double> graded(double low, double high, double peak, double width) {
  std::vector<double> cuts{low, high};
  const auto add = [&](double cut) {
    if (cut > low && cut < high) cuts.push_back(cut);
  };
  add(peak);
  for (double distance = 2 * width; distance < high - low; distance *= 6) {
    add(peak - distance);
    add(peak + distance);
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

std::vector<Box> boxes(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Box> all;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      all.push_back({x[i], x[i + 1], y[j], y[j + 1]});
    }
  }
  return all;
}

// Polar angle and azimuth of the light. An eye in the xz plane sees an isotropic lobe the same on
// both sides of it: half of the circle is enough, and functions of sines (m < 0) vanish.
std::vector<Box> light_boxes(const Lobe& lobe, const Direction& eye, bool half) {
  const double theta = std::acos(std::min(1.0, eye.z));
  const double peak = half ? kPi : std::atan2(-eye.y, -eye.x);
  const double width = lobe.width() / std::max(std::sin(theta), lobe.width() / kPi);
  return boxes(graded(0, kPi / 2, theta, lobe.width()),
               graded(half ? 0 : peak - kPi, half ? kPi : peak + kPi, peak, width));
}

std::vector<double> even(double low, double high, int count) {
  std::vector<double> cuts;
  for (int i = 0; i <= count; ++i) cuts.push_back(low + (high - low) * i / count);
  return cuts;
}

// Of SlopeDomain.
std::vector<Box> slope_boxes(bool half) {
  return boxes(half ? even(0, kPi / 2, 2) : even(-kPi / 2, kPi / 2, 4), even(0, 1, 3));
}

/// The light at a point of light_boxes() or, with a scale, of slope_boxes().
std::function<SlopeDomain::Light(const Point&)> light_map(const std::optional<Imath::V2d>& scale,
                                                          const Direction& eye) {
  using Light = SlopeDomain::Light;
  if (!scale) return [](const Point& p) { return Light{direction(p), std::sin(p.x)}; };
  const SlopeDomain slopes(*scale, eye);
  return [slopes, tau = 0.0, chord = slopes.chord(0)](const Point& p) mutable {
    if (p.x != tau) chord = slopes.chord(tau = p.x);
    return chord.at(p.y);
  };
}

/// Coordinates of an eye in one quadrant, logarithms of its height above the horizon and of its
/// azimuth from the plane in which the lobe is narrow: where it is as near to either as the lobe is
/// wide, what it sees changes. At the horizon itself some lobes have a term h log h in the height
/// h: there it is the coordinate's square.
class EyeDomain {
 public:
  explicit EyeDomain(const Lobe& lobe) : height_(lobe.width()) {
    const Imath::V2d scale = lobe.slope_scale().value_or(Imath::V2d(1));
    azimuth_ = std::min(scale.x, scale.y) / std::max(scale.x, scale.y);
    from_y_ = scale.y < scale.x;
    isotropic_ = lobe.is_isotropic();
  }

  std::vector<Box> boxes_of_all() const {
    std::vector<double> heights{0}, azimuths{0};
    for (const double angle : {0.15, 0.7, kPi / 2}) {
      if (angle > height_) heights.push_back(std::sqrt(std::asinh(angle / height_)));
      if (angle > azimuth_) azimuths.push_back(std::asinh(angle / azimuth_));
    }
    return boxes(heights, isotropic_ ? std::vector<double>{0, 0} : azimuths);
  }

  struct Eye {
    Direction direction;
    double density;  ///< solid angle (sr) per area of the coordinates; isotropic: per length
  };
  Eye at(const Point& point) const {
    const double x = point.x * point.x, theta = kPi / 2 - height_ * std::sinh(x);
    const double azimuth = azimuth_ * std::sinh(point.y);
    const double density = std::sin(theta) * height_ * std::cosh(x) * 2 * point.x;
    return {brdf::direction({theta, from_y_ ? kPi / 2 - azimuth : azimuth}),
            isotropic_ ? density : density * azimuth_ * std::cosh(point.y)};
  }

 private:
  double height_, azimuth_;
  bool from_y_, isotropic_;
};

int order_of(std::size_t coefficient) {
  const int l = static_cast<int>(std::sqrt(static_cast<double>(coefficient) + 0.5));
  return static_cast<int>(coefficient) - sh::coefficient_index(l, 0);
}

/// Functions of the eye: all y_i(v) g_j(v), then the energies.
class EyeIntegrand {
 public:
  EyeIntegrand(const Lobe& lobe, int row_band_count, int column_band_count, double tolerance)
      : lobe_(lobe),
        eyes_(lobe),
        row_band_count_(row_band_count),
        column_band_count_(column_band_count),
        tolerance_(tolerance) {}

  std::size_t matrix_size() const {
    return sh::row_size(row_band_count_) * sh::row_size(column_band_count_);
  }
  std::size_t value_count() const { return matrix_size() + 2; }
  double light_error() const { return light_error_; }
  std::vector<Box> domain() const { return eyes_.boxes_of_all(); }

  void operator()(std::span<const Point> points, std::span<double> values) {
    std::vector<double> errors(points.size());
    parallel_for(points.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        errors[p] = at(points[p], values.subspan(p * value_count(), value_count()));
      }
    });
    for (double error : errors) light_error_ = std::max(light_error_, error);
  }

 private:
  double at(const Point& point, std::span<double> values) const {
    const auto [eye, density] = eyes_.at(point);
    const LobeMoments light = lobe_moments(lobe_, eye, column_band_count_, tolerance_);
    const std::size_t column_count = light.values.size() - 1;
    std::vector<double> row(sh::row_size(row_band_count_));
    sh::evaluate(row_band_count_, eye.x, eye.y, eye.z, row);
    double* value = values.data();
    for (double y : row) {
      for (std::size_t j = 0; j < column_count; ++j) *value++ = density * y * light.values[j];
    }
    double energy = 0;
    for (std::size_t j = 0; j < column_count; ++j) energy += light.values[j] * light.values[j];
    *value++ = density * energy;
    *value = density * light.values.back();
    return light.error;
  }

  const Lobe& lobe_;
  EyeDomain eyes_;
  int row_band_count_, column_band_count_;
  double tolerance_;
  double light_error_ = 0;
};

// From the eye's azimuth 0 to all: of the integrals over the azimuth only those of cos² mφ or
// sin² mφ are not 0, and both have the factor of |m|.
double isotropic_entry(const std::vector<double>& values, std::size_t column_count, std::size_t i,
                       std::size_t j) {
  const int m = order_of(i);
  if (m != order_of(j)) return 0;
  const std::size_t up = m < 0 ? static_cast<std::size_t>(-2 * m) : 0;
  return (m == 0 ? 2 * kPi : kPi) * values[(i + up) * column_count + j + up];
}

// From a quadrant to all four, which have the same lobe: functions of other symmetry about one of
// the two planes cancel.
double quadrant_entry(const std::vector<double>& values, std::size_t column_count, std::size_t i,
                      std::size_t j) {
  const int m = order_of(i), n = order_of(j);
  const bool same = (m < 0) == (n < 0) && (m - n) % 2 == 0;
  return same ? 4 * values[i * column_count + j] : 0;
}

}  // namespace

LobeMoments lobe_moments(const Lobe& lobe, const Direction& eye, int band_count, double tolerance) {
  const std::size_t count = sh::row_size(band_count);
  const bool half = lobe.is_isotropic() && eye.y == 0 && eye.x >= 0;
  const auto scale = lobe.slope_scale();
  const auto light_at = light_map(scale, eye);
  std::vector<double> basis(count);
  const Integrand integrand = [&](std::span<const Point> points, std::span<double> values) {
    double* value = values.data();
    for (const Point& point : points) {
      const auto [light, density] = light_at(point);
      const double kernel = lobe.evaluate(light, eye) * light.z;
      const double factor = (half ? 2 : 1) * kernel * density;
      sh::evaluate(band_count, light.x, light.y, light.z, basis);
      for (double y : basis) *value++ = factor * y;
      *value++ = factor * kernel;
    }
  };
  CubatureOptions options;
  options.value_count = count + 1;
  options.controlled_count = count;
  options.tolerance = tolerance;
  options.max_box_count = 400;
  const CubatureResult result =
      integrate(scale ? slope_boxes(half) : light_boxes(lobe, eye, half), integrand, options);
  LobeMoments moments{result.values, result.error};
  for (std::size_t i = 0; half && i < count; ++i) {
    if (order_of(i) < 0) moments.values[i] = 0;
  }
  return moments;
}

double directional_albedo(const Lobe& lobe, const Direction& eye, double tolerance) {
  return std::sqrt(4 * kPi) * lobe_moments(lobe, eye, 1, tolerance).values[0];
}

// The error of the light's integral enters B by at most ∫_H |y_i| <= sqrt(π) of it.
LobeMatrix compute_lobe_matrix(const Lobe& lobe, int row_band_count, int column_band_count,
                               double tolerance) {
  assert(row_band_count >= 1 && row_band_count <= sh::kMaxBandCount);
  assert(column_band_count >= 1 && column_band_count <= sh::kMaxBandCount);
  EyeIntegrand integrand(lobe, row_band_count, column_band_count, tolerance / 4);
  const bool isotropic = lobe.is_isotropic();
  const double factor = isotropic ? 2 * kPi : 4;  // the rest of the circle
  CubatureOptions options;
  options.value_count = integrand.value_count();
  options.controlled_count = integrand.matrix_size();
  options.tolerance = tolerance / 2 / factor;
  options.max_box_count = 40;
  const CubatureResult result = integrate(integrand.domain(), std::ref(integrand), options);

  LobeMatrix matrix{row_band_count, column_band_count, {}, 0, 0, 0};
  const std::size_t column_count = sh::row_size(column_band_count);
  for (std::size_t i = 0; i < sh::row_size(row_band_count); ++i) {
    for (std::size_t j = 0; j < column_count; ++j) {
      matrix.values.push_back(isotropic ? isotropic_entry(result.values, column_count, i, j)
                                        : quadrant_entry(result.values, column_count, i, j));
    }
  }
  matrix.error = factor * result.error + std::sqrt(kPi) * integrand.light_error();
  matrix.exit_energy = factor * result.values[options.controlled_count];
  matrix.kernel_energy = factor * result.values.back();
  return matrix;
}

}  // namespace prt::brdf
