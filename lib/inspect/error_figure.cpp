#include "inspect/error_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "image/false_color.h"
#include "inspect/canvas.h"
#include "inspect/mesh_picture.h"
#include "inspect/statistics.h"

namespace prt::inspect {

namespace {

constexpr int kGap = 24, kColumn = 340, kFirstRow = 64, kHistogramHeight = 130, kBins = 50,
              kBarHeight = 14, kTicks = 5;
constexpr int kHistogramTop = kFirstRow + 2 * kColumn,
              kHistogramBottom = kHistogramTop + kHistogramHeight, kBarTop = kHistogramBottom + 28,
              kFigureHeight = kBarTop + kBarHeight + 58;

using Bins = std::array<std::size_t, kBins>;

/// From 0 to the scale; the last bin has all that is more.
Bins count(std::span<const double> errors, double scale) {
  Bins bins{};
  for (const double error : errors) {
    const double bin = scale > 0.0 ? error / scale * kBins : 0.0;
    ++bins[static_cast<std::size_t>(std::min(bin, kBins - 1.0))];
  }
  return bins;
}

void draw_histogram(Canvas& canvas, int left, const Bins& bins, std::size_t most) {
  for (int i = 0; i < kBins; ++i) {
    const auto share = static_cast<double>(bins[static_cast<std::size_t>(i)]) /
                       static_cast<double>(std::max<std::size_t>(most, 1));
    const int height = static_cast<int>(std::ceil(share * (kHistogramHeight - 16)));
    const int x = left + i * kColumn / kBins, next = left + (i + 1) * kColumn / kBins;
    canvas.fill(x, kHistogramBottom - height, next - x - 1, height,
                image::heat_color((static_cast<float>(i) + 0.5f) / kBins));
  }
  canvas.fill(left, kHistogramBottom, kColumn, 1, kBlack);
}

/// As wide as the histograms, over which it has the same values at the same places.
void draw_color_bar(Canvas& canvas, int left, double scale) {
  for (int x = 0; x < kColumn; ++x) {
    canvas.fill(left + x, kBarTop, 1, kBarHeight,
                image::heat_color((static_cast<float>(x) + 0.5f) / kColumn));
  }
  for (int i = 0; i <= kTicks; ++i) {
    const int x = left + i * kColumn / kTicks;
    const std::string text =
        fmt::format("{:.3g}{}", scale * i / kTicks, i == kTicks ? " and more" : "");
    canvas.fill(x, kBarTop + kBarHeight, 1, 5, kBlack);
    canvas.text(x - (i == kTicks ? 20 : Canvas::text_width(text) / 2), kBarTop + kBarHeight + 9,
                text, kBlack);
  }
  canvas.text(left, kBarTop + kBarHeight + 28, "error of a vertex / root mean square transfer",
              kBlack);
}

}  // namespace

image::Image draw(const mesh::Scene& scene, std::span<const EncodingError> errors,
                  const std::string& title) {
  double scale = 0.0;
  for (const EncodingError& error : errors) {
    std::vector<double> sorted = error.relative;
    if (!sorted.empty()) scale = std::max(scale, percentile(sorted, 0.99));
  }
  std::vector<Bins> bins;
  std::size_t most = 0;
  for (const EncodingError& error : errors) {
    bins.push_back(count(error.relative, scale));
    most = std::max(most, *std::max_element(bins.back().begin(), bins.back().end()));
  }
  const auto column_count = static_cast<int>(errors.size());
  Canvas canvas(column_count * (kColumn + kGap) + 3 * kGap, kFigureHeight, kWhite);
  canvas.text(kGap, 14, title, kBlack);
  for (int i = 0; i < column_count; ++i) {
    const EncodingError& error = errors[static_cast<std::size_t>(i)];
    const int left = kGap + i * (kColumn + kGap);
    canvas.text(left, kFirstRow - 24,
                fmt::format("{} (SE {:.4g})", error.name, error.squared_error), kBlack);
    std::vector<Vec3> colors;
    for (const double value : error.relative) {
      colors.push_back(image::heat_color(scale > 0.0 ? static_cast<float>(value / scale) : 0.0f));
    }
    for (const bool behind : {false, true}) {
      draw_surface(canvas, left, kFirstRow + (behind ? kColumn : 0), kColumn, scene, colors,
                   {.is_smooth = true, .is_shaded = false, .is_from_behind = behind});
    }
    draw_histogram(canvas, left, bins[static_cast<std::size_t>(i)], most);
  }
  canvas.text(kGap, kHistogramTop, fmt::format("vertices by error, the highest bar is {}", most),
              kBlack);
  draw_color_bar(canvas, kGap, scale);
  return canvas.linear();
}

std::string to_csv(std::span<const EncodingError> errors) {
  std::string csv = "vertex";
  for (const EncodingError& error : errors) csv += "," + error.name;
  csv += '\n';
  for (std::size_t p = 0; !errors.empty() && p < errors[0].relative.size(); ++p) {
    csv += fmt::format("{}", p);
    for (const EncodingError& error : errors) csv += fmt::format(",{:.6g}", error.relative[p]);
    csv += '\n';
  }
  return csv;
}

}  // namespace prt::inspect
