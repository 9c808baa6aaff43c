// Textures of mesh files become PNG inside the .glb.
#pragma once

#include <cstddef>
#include <vector>

#include "image/image.h"

namespace prt::gltf {

/// 8-bit sRGB PNG of a linear image of 1 to 4 channels (alpha stays linear). Throws Error (failed).
std::vector<std::byte> encode_png(const image::Image& image);

}  // namespace prt::gltf
