#include "inspect/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "inspect/canvas.h"
#include "inspect/statistics.h"

namespace prt::inspect {

namespace {

constexpr int kMostDecades = 6;

const Vec3 kBarColor(0.30f, 0.47f, 0.66f);
const Vec3 kMarkColor(0.80f, 0.25f, 0.20f);

// Where the plot's parts are, in pixels.
struct Layout {
  int left = 64, top = 44, width = 640, height = 320;
  int bottom() const { return top + height; }
};

// A round number of counts between ticks: 1, 2 or 5 times a power of ten, about five ticks.
double tick_step(double highest) {
  const double rough = std::max(highest / 5.0, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

void draw_count_axis(Canvas& canvas, const Layout& layout, double top_count) {
  const double step = tick_step(top_count);
  for (double count = 0.0; count <= top_count; count += step) {
    const int y = layout.bottom() - static_cast<int>(count / top_count * layout.height);
    if (count > 0.0) canvas.fill(layout.left, y, layout.width, 1, kGray);
    canvas.fill(layout.left - 5, y, 5, 1, kBlack);
    const std::string label = fmt::format("{:.0f}", count);
    canvas.text(layout.left - 9 - Canvas::text_width(label), y - 4, label, kBlack);
  }
  canvas.fill(layout.left, layout.top, 1, layout.height, kBlack);
  canvas.text(layout.left - 5, layout.top - 16, "vertices", kBlack);
}

void draw_value_axis(Canvas& canvas, const Layout& layout, const Histogram& histogram,
                     const std::string& label) {
  const int decades = histogram.last_decade - histogram.first_decade;
  for (int i = 0; i <= decades; ++i) {
    const int x = layout.left + i * layout.width / decades;
    canvas.fill(x, layout.bottom(), 1, 6, kBlack);
    const int decade = histogram.first_decade + i;
    const std::string text = decade < -3 || decade > 3
                                 ? fmt::format("1e{}", decade)
                                 : fmt::format("{:g}", std::pow(10.0, decade));
    canvas.text(x - Canvas::text_width(text) / 2, layout.bottom() + 10, text, kBlack);
    for (int minor = 2; minor < 10 && i < decades; ++minor) {
      const double offset = (i + std::log10(minor)) / decades;
      canvas.fill(layout.left + static_cast<int>(offset * layout.width), layout.bottom(), 1, 3,
                  kBlack);
    }
  }
  canvas.fill(layout.left, layout.bottom(), layout.width, 1, kBlack);
  canvas.text(layout.left + (layout.width - Canvas::text_width(label)) / 2, layout.bottom() + 28,
              label, kBlack);
}

void draw_mark(Canvas& canvas, const Layout& layout, const Histogram& histogram, double value,
               const std::string& name, int row) {
  const double decades = histogram.last_decade - histogram.first_decade;
  const double share = (std::log10(value) - histogram.first_decade) / decades;
  if (!(share >= 0.0 && share <= 1.0)) return;
  const int x = layout.left + static_cast<int>(share * layout.width);
  for (int y = layout.top; y < layout.bottom(); y += 6) canvas.fill(x, y, 1, 3, kMarkColor);
  const std::string label = fmt::format("{} {:.3g}", name, value);
  const int width = Canvas::text_width(label);
  const bool fits = x + 5 + width < layout.left + layout.width;
  canvas.text(fits ? x + 5 : x - 5 - width, layout.top + 14 * row, label, kMarkColor);
}

}  // namespace

double Histogram::lower_edge(std::size_t bin) const {
  return std::pow(10.0, first_decade + static_cast<double>(bin) / kBinsPerDecade);
}

Histogram make_histogram(std::vector<double> values) {
  Histogram histogram;
  double low = INFINITY, high = 0.0;
  for (const double value : values) {
    high = std::max(high, value);
    if (value > 0.0) low = std::min(low, value);
  }
  if (high > 0.0) {
    histogram.last_decade = static_cast<int>(std::floor(std::log10(high))) + 1;
    histogram.first_decade = std::max(static_cast<int>(std::floor(std::log10(low))),
                                      histogram.last_decade - kMostDecades);
  } else {
    histogram.last_decade = 1;
  }
  const int decades = histogram.last_decade - histogram.first_decade;
  const int bin_count = Histogram::kBinsPerDecade * decades;
  histogram.counts.resize(static_cast<std::size_t>(bin_count));
  for (const double value : values) {
    if (value == 0.0) {
      ++histogram.zero_count;
      continue;
    }
    const double bin = (std::log10(value) - histogram.first_decade) * Histogram::kBinsPerDecade;
    const int clamped = static_cast<int>(std::clamp(bin, 0.0, bin_count - 1.0));
    ++histogram.counts[static_cast<std::size_t>(clamped)];
  }
  if (!values.empty()) {
    histogram.median = percentile(values, 0.5);
    histogram.percentile_99 = percentile(values, 0.99);
  }
  return histogram;
}

std::string to_csv(const Histogram& histogram) {
  std::string csv = fmt::format("lower,upper,count\n0,0,{}\n", histogram.zero_count);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    csv += fmt::format("{:.6g},{:.6g},{}\n", histogram.lower_edge(i), histogram.lower_edge(i + 1),
                       histogram.counts[i]);
  }
  return csv;
}

image::Image plot(const Histogram& histogram, const std::string& title,
                  const std::string& axis_label) {
  const Layout layout;
  Canvas canvas(layout.left + layout.width + 32, layout.bottom() + 52, kWhite);
  const std::size_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double top_count = std::max(1.0, 1.08 * static_cast<double>(most));
  draw_count_axis(canvas, layout, top_count);
  const auto bin_count = static_cast<int>(histogram.counts.size());
  for (int i = 0; i < bin_count; ++i) {
    const int x = layout.left + i * layout.width / bin_count;
    const int next = layout.left + (i + 1) * layout.width / bin_count;
    const auto count = static_cast<double>(histogram.counts[static_cast<std::size_t>(i)]);
    const int height = static_cast<int>(std::ceil(count / top_count * layout.height));
    canvas.fill(x + 1, layout.bottom() - height, next - x - 1, height, kBarColor);
  }
  draw_value_axis(canvas, layout, histogram, axis_label);
  draw_mark(canvas, layout, histogram, histogram.median, "median", 0);
  draw_mark(canvas, layout, histogram, histogram.percentile_99, "99%", 1);
  canvas.text((canvas.width() - Canvas::text_width(title)) / 2, 10, title, kBlack);
  return canvas.linear();
}

}  // namespace prt::inspect
