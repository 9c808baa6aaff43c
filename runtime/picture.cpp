#include "runtime/picture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "runtime/shading.h"

namespace prt::runtime {

void check_exposure(float stops) {
  constexpr float kMost = 64.0f;
  if (std::abs(stops) <= kMost) return;  // not so for NaN
  throw Error(ErrorKind::usage, "the exposure is out of range",
              {.found = std::to_string(stops), .expected = "-64 to 64 stops"});
}

image::Image developed(const image::Image& linear, const DevelopOptions& options) {
  image::Image picture(linear.width, linear.height, options.transparent ? 4 : 3);
  const float factor = std::exp2(options.exposure);
  parallel_for(static_cast<std::size_t>(linear.height), 16,
               [&](std::size_t begin, std::size_t end) {
                 for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                   for (int x = 0; x < linear.width; ++x) {
                     const float* const in = linear.at(x, y);
                     float* const out = picture.at(x, y);
                     Vec3 color(in[0], in[1], in[2]);
                     if (options.transparent) {
                       out[3] = in[3];
                       if (in[3] > 0.0f) color /= in[3];
                     }
                     if (options.tone_mapped) color = tone_map(color * factor);
                     for (int c = 0; c < 3; ++c) out[c] = std::clamp(color[c], 0.0f, 1.0f);
                   }
               });
  return picture;
}

void write_picture(const std::filesystem::path& path, const image::Image& linear,
                   const DevelopOptions& options, bool no_clobber) {
  const bool is_float = lower_extension(path) == ".exr";
  image::write_image(path, is_float ? linear : developed(linear, options), no_clobber);
}

}  // namespace prt::runtime
