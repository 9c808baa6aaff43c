#include "inspect/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "image/false_color.h"
#include "inspect/canvas.h"
#include "inspect/statistics.h"

namespace prt::inspect {

namespace {

void check_size(const char* name, const image::Image& image, const image::Image& reference,
                int least_channels) {
  if (image.width == reference.width && image.height == reference.height &&
      image.channel_count >= least_channels) {
    return;
  }
  throw_bad_input(fmt::format("the {} does not fit the reference", name),
                  {.found = fmt::format("{} x {} pixels, {} channels", image.width, image.height,
                                        image.channel_count),
                   .expected = fmt::format("{} x {} pixels, {} channels or more", reference.width,
                                           reference.height, least_channels)});
}

bool is_radiance(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".exr" || extension == ".hdr";
}

bool counts(const ComparisonInput& input, int x, int y) {
  const auto covered = [&](const image::Image& image) {
    return image.channel_count < 4 || image.at(x, y)[3] == 1.0f;
  };
  return covered(input.image) && covered(input.reference) &&
         (!input.mask || input.mask->at(x, y)[0] > 0.5f);
}

struct PixelSums {
  std::size_t pixel_count = 0;
  double square = 0.0, reference_square = 0.0, noise_square = 0.0, value = 0.0, reference = 0.0;
  double worst = -1.0;
  int worst_x = 0, worst_y = 0;
  std::vector<double> differences;
};

void add_pixel(const ComparisonInput& input, int x, int y, PixelSums& sums, float& difference) {
  const float* a = input.image.at(x, y);
  const float* b = input.reference.at(x, y);
  double square = 0.0;
  for (int c = 0; c < 3; ++c) {
    square += (double{a[c]} - b[c]) * (double{a[c]} - b[c]);
    sums.reference_square += double{b[c]} * b[c];
    sums.value += a[c];
    sums.reference += b[c];
    if (input.noise) {
      const double error = input.noise->at(x, y)[c];
      sums.noise_square += error * error;
    }
  }
  sums.square += square;
  ++sums.pixel_count;
  difference = static_cast<float>(std::sqrt(square));
  sums.differences.push_back(difference);
  if (difference > sums.worst) {
    sums.worst = difference;
    sums.worst_x = x;
    sums.worst_y = y;
  }
}

Json to_json(const PixelSums& sums, bool with_noise) {
  const double value_count = 3.0 * static_cast<double>(sums.pixel_count);
  const auto relative = [&](double square) {
    return sums.reference_square > 0.0 ? std::sqrt(square / sums.reference_square) : 0.0;
  };
  Json json = {{"pixel_count", sums.pixel_count},
               {"relative_rmse", relative(sums.square)},
               {"rmse", std::sqrt(sums.square / value_count)},
               {"bias", (sums.value - sums.reference) / value_count},
               {"relative_bias",
                sums.reference != 0.0 ? (sums.value - sums.reference) / sums.reference : 0.0},
               {"reference_mean", sums.reference / value_count},
               {"difference", percentiles_of(sums.differences)},
               {"worst_pixel", {sums.worst_x, sums.worst_y}}};
  if (with_noise) {
    json["noise_relative_rmse"] = relative(sums.noise_square);
    json["noise_share"] = sums.square > 0.0 ? sums.noise_square / sums.square : 0.0;
    json["relative_rmse_without_noise"] = relative(std::max(sums.square - sums.noise_square, 0.0));
  }
  return json;
}

}  // namespace

Comparison compare(const ComparisonInput& input) {
  check_size("reference", input.reference, input.reference, 3);
  check_size("image", input.image, input.reference, 3);
  if (input.mask) check_size("mask", *input.mask, input.reference, 1);
  if (input.noise) check_size("noise image", *input.noise, input.reference, 3);
  Comparison result;
  result.difference = image::Image(input.reference.width, input.reference.height, 1);
  PixelSums sums;
  for (int y = 0; y < input.reference.height; ++y) {
    for (int x = 0; x < input.reference.width; ++x) {
      float& difference = *result.difference.at(x, y);
      difference = -1.0f;
      if (counts(input, x, y)) add_pixel(input, x, y, sums, difference);
    }
  }
  if (sums.pixel_count == 0) {
    throw_bad_input("no pixel to compare",
                    {.expected = "pixels with alpha 1 in both images, inside the mask"});
  }
  result.json = to_json(sums, input.noise.has_value());
  return result;
}

image::Image heatmap(const Comparison& comparison, double scale) {
  constexpr int kLegendHeight = 44, kBarHeight = 16, kMargin = 10;
  const image::Image& difference = comparison.difference;
  Canvas canvas(std::max(difference.width, 200), difference.height + kLegendHeight, kWhite);
  for (int y = 0; y < difference.height; ++y) {
    for (int x = 0; x < difference.width; ++x) {
      const float d = *difference.at(x, y);
      const double heat = d > 0.0f ? d / scale : 0.0;  // not 0 / 0 of equal images
      canvas.fill(x, y, 1, 1, d < 0.0f ? Vec3(0.25f) : image::heat_color(static_cast<float>(heat)));
    }
  }
  const int bar_width = canvas.width() - 2 * kMargin;
  const int bar_y = difference.height + 6;
  for (int i = 0; i < bar_width; ++i) {
    canvas.fill(kMargin + i, bar_y, 1, kBarHeight,
                image::heat_color((static_cast<float>(i) + 0.5f) / static_cast<float>(bar_width)));
  }
  const int text_y = bar_y + kBarHeight + 5;
  const std::string high = fmt::format("{:.3g}", scale);
  canvas.text(kMargin, text_y, "0", kBlack);
  canvas.text(kMargin + (bar_width - Canvas::text_width("difference (radiance)")) / 2, text_y,
              "difference (radiance)", kBlack);
  canvas.text(kMargin + bar_width - Canvas::text_width(high), text_y, high, kBlack);
  return canvas.linear();
}

void compare_files(const ComparisonFiles& files, bool no_clobber, Report& report, Json& json) {
  const StageTimer timer(report, "compare");
  const auto read = [&](const std::filesystem::path& path) {
    report.add_input(path);
    return image::read_image(path);
  };
  if (is_radiance(files.image) != is_radiance(files.reference)) {
    log::warning("{} and {}: one is radiance, the other was tone mapped: they differ by that alone",
                 files.image.string(), files.reference.string());
  }
  ComparisonInput input{read(files.image), read(files.reference), {}, {}};
  if (!files.mask.empty()) input.mask = read(files.mask);
  if (!files.noise.empty()) input.noise = read(files.noise);
  const Comparison comparison = compare(input);
  json["image"] = files.image.string();
  json["reference"] = files.reference.string();
  json["comparison"] = comparison.json;
  if (files.heatmap.empty()) return;
  const double scale = files.heatmap_max > 0.0 ? files.heatmap_max
                                               : comparison.json["difference"]["p99"].get<double>();
  image::write_image(files.heatmap, heatmap(comparison, scale), no_clobber);
  report.add_output(files.heatmap);
}

}  // namespace prt::inspect
