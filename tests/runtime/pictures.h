// Rendered pictures, compared.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/cpu_pixels.h"
#include "runtime/renderer.h"

namespace prt::runtime {

/// Largest difference over all channels of all pixels; both images must show something.
inline float largest_difference(const image::Image& a, const image::Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  float largest = 0.0f;
  std::size_t covered_count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    covered_count += i % 4 == 3 && a.pixels[i] > 0.0f;
  }
  EXPECT_GT(covered_count, 500u) << "nothing was drawn";
  return largest;
}

inline View view_of(const Model& model) {
  View view;
  view.camera = camera::frame(model.bounds, 40, static_cast<float>(kWidth) / kHeight);
  view.background = Background::none;
  return view;
}

/// That pixels of a picture of view_of(model), one sample each, are those of the CPU to a step of
/// an 8-bit picture.
inline void expect_cpu_pixels(const Model& model, Draw draw, const LightField& field,
                              const image::Image& image) {
  View view = view_of(model);
  view.draw = draw;
  const CpuPixels cpu(model, view, field);
  std::size_t compared_count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      Vec3 expected;
      if (!cpu.radiance(x, y, expected)) continue;
      ++compared_count;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y)[c], expected[c], 1.0f / 255.0f);
      EXPECT_EQ(image.at(x, y)[3], 1.0f);
    }
  EXPECT_GT(compared_count, 500u);
}

inline void expect_cpu_pixels(const Model& model, Draw draw, const sh::Light& light,
                              const image::Image& image) {
  expect_cpu_pixels(model, draw, LightField{{}, {light}}, image);
}

}  // namespace prt::runtime
