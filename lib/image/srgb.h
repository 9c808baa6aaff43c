// The sRGB transfer curve, IEC 61966-2-1.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace prt::image {

/// Of one value in [0, 1].
float linear_from_srgb(float encoded);
float srgb_from_linear(float linear);

/// Channels 0 to 2 (or 0 of a grey image) encoded and rounded, alpha only rounded; clamped to
/// [0, 1]. width × height × channel_count bytes.
std::vector<std::uint8_t> srgb8_from_linear(const Image& image);

}  // namespace prt::image
