// A path traced picture against what it should be, with the noise it is known to have.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "camera/camera.h"
#include "reference/path_tracer.h"

namespace prt::reference {

/// Unit direction from the eye through the centre of a pixel of a size × size picture.
inline Vec3 pixel_direction(const camera::Camera& camera, int size, int x, int y) {
  const auto scale = 1.0f / static_cast<float>(size);
  return camera.ray_direction((2.0f * static_cast<float>(x) + 1.0f) * scale - 1.0f,
                              1.0f - (2.0f * static_cast<float>(y) + 1.0f) * scale);
}

struct Comparison {
  double difference = 0;  ///< mean, of all pixels and channels
  double deviation = 0;   ///< root mean square
  double noise = 0;       ///< root mean square of the standard errors
  double energy = 0;      ///< root mean square of what is expected
  int count = 0;          ///< pixels
};

/// Of the pixels that are covered; those for which `expected` gives nothing are left out.
inline Comparison compare(const Result& result,
                          const std::function<std::optional<Vec3>(int, int)>& expected) {
  Comparison sum;
  for (int y = 0; y < result.radiance.height; ++y) {
    for (int x = 0; x < result.radiance.width; ++x) {
      if (result.radiance.at(x, y)[3] != 1.0f) continue;
      const auto value = expected(x, y);
      if (!value) continue;
      ++sum.count;
      for (int c = 0; c < 3; ++c) {
        const double difference = double{result.radiance.at(x, y)[c]} - double{(*value)[c]};
        sum.difference += difference;
        sum.deviation += difference * difference;
        sum.noise += std::pow(result.standard_error.at(x, y)[c], 2);
        sum.energy += std::pow((*value)[c], 2);
      }
    }
  }
  const double n = 3.0 * std::max(sum.count, 1);
  return {sum.difference / n, std::sqrt(sum.deviation / n), std::sqrt(sum.noise / n),
          std::sqrt(sum.energy / n), sum.count};
}

/// Neither biased nor further off than noise explains. Channels share their paths, so that the mean
/// of all is as certain as that of a third as many.
inline void expect_equal(const Comparison& found, int least_count, double relative_tolerance) {
  const double tolerance = relative_tolerance * found.energy;
  EXPECT_GE(found.count, least_count);
  EXPECT_NEAR(found.difference, 0.0, 4.0 * found.noise / std::sqrt(found.count) + tolerance);
  EXPECT_LT(found.deviation, 1.5 * found.noise + tolerance);
}

}  // namespace prt::reference
