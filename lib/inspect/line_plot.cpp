#include "inspect/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/false_color.h"
#include "inspect/canvas.h"

namespace prt::inspect {

namespace {

constexpr int kLeft = 72, kTop = 44, kWidth = 560, kHeight = 360, kLegendWidth = 130;
constexpr int kBottom = kTop + kHeight, kRight = kLeft + kWidth;

/// Values on one axis and where they are in pixels.
class Axis {
 public:
  Axis(bool logarithmic, int from, int to) : logarithmic_(logarithmic), from_(from), to_(to) {}

  bool has(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0.0); }
  void include(double value) {
    if (!has(value)) return;
    low_ = std::min(low_, scaled(value));
    high_ = std::max(high_, scaled(value));
  }
  /// Widens to whole decades, or a unit where there is but one value.
  void finish() {
    if (low_ > high_) low_ = high_ = 0.0;
    if (logarithmic_) {
      low_ = std::floor(low_);
      high_ = std::ceil(high_);
    }
    if (low_ == high_) high_ = low_ + 1.0;
  }
  int pixel(double value) const {
    return from_ +
           static_cast<int>(std::lround((scaled(value) - low_) / (high_ - low_) * (to_ - from_)));
  }
  std::vector<double> ticks() const {
    const double step = std::max(1.0, std::ceil((high_ - low_) / 10.0));
    std::vector<double> values;
    for (double at = std::ceil(low_); at <= high_; at += step) {
      values.push_back(logarithmic_ ? std::pow(10.0, at) : at);
    }
    return values;
  }

 private:
  double scaled(double value) const { return logarithmic_ ? std::log10(value) : value; }

  bool logarithmic_;
  int from_, to_;
  double low_ = INFINITY, high_ = -INFINITY;
};

std::string tick_text(double value) {
  return value != 0.0 && (value < 1e-3 || value >= 1e4) ? fmt::format("{:.0e}", value)
                                                        : fmt::format("{:g}", value);
}

void draw_axes(Canvas& canvas, const LinePlot& plot, const Axis& x_axis, const Axis& y_axis) {
  for (const double value : x_axis.ticks()) {
    const int x = x_axis.pixel(value);
    const std::string text = tick_text(value);
    canvas.fill(x, kTop, 1, kHeight, kGray);
    canvas.text(x - Canvas::text_width(text) / 2, kBottom + 8, text, kBlack);
  }
  for (const double value : y_axis.ticks()) {
    const int y = y_axis.pixel(value);
    const std::string text = tick_text(value);
    canvas.fill(kLeft, y, kWidth, 1, kGray);
    canvas.text(kLeft - 8 - Canvas::text_width(text), y - 4, text, kBlack);
  }
  canvas.fill(kLeft, kTop, 1, kHeight, kBlack);
  canvas.fill(kLeft, kBottom, kWidth, 1, kBlack);
  canvas.text(kLeft + (kWidth - Canvas::text_width(plot.x_label)) / 2, kBottom + 28, plot.x_label,
              kBlack);
  canvas.text(8, kTop - 16, plot.y_label, kBlack);
  canvas.text((canvas.width() - Canvas::text_width(plot.title)) / 2, 10, plot.title, kBlack);
}

void draw_line(Canvas& canvas, int x0, int y0, int x1, int y1, const Vec3& color) {
  const int steps = std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1});
  for (int i = 0; i <= steps; ++i) {
    canvas.fill(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, 2, 2, color);
  }
}

void draw_series(Canvas& canvas, const Series& series, const Axis& x_axis, const Axis& y_axis,
                 const Vec3& color) {
  bool begun = false;
  int last_x = 0, last_y = 0;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!x_axis.has(series.x[i]) || !y_axis.has(series.y[i])) continue;
    const int x = x_axis.pixel(series.x[i]), y = y_axis.pixel(series.y[i]);
    if (begun) draw_line(canvas, last_x, last_y, x, y, color);
    canvas.fill(x - 2, y - 2, 6, 6, color);
    begun = true;
    last_x = x;
    last_y = y;
  }
}

}  // namespace

std::string to_csv(const LinePlot& plot) {
  std::string csv = fmt::format("series,{},{}\n", plot.x_label, plot.y_label);
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      csv += fmt::format("{},{:.9g},{:.9g}\n", series.name, series.x[i], series.y[i]);
    }
  }
  return csv;
}

image::Image draw(const LinePlot& plot) {
  Axis x_axis(plot.log_x, kLeft, kRight), y_axis(true, kBottom, kTop);
  for (const Series& series : plot.series) {
    for (const double x : series.x) x_axis.include(x);
    for (const double y : series.y) y_axis.include(y);
  }
  x_axis.finish();
  y_axis.finish();
  Canvas canvas(kRight + kLegendWidth, kBottom + 52, kWhite);
  draw_axes(canvas, plot, x_axis, y_axis);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Vec3 color = image::cluster_color(i + 1);
    draw_series(canvas, plot.series[i], x_axis, y_axis, color);
    const int y = kTop + 18 * static_cast<int>(i);
    canvas.fill(kRight + 12, y + 2, 14, 4, color);
    canvas.text(kRight + 32, y, plot.series[i].name, kBlack);
  }
  return canvas.linear();
}

}  // namespace prt::inspect
