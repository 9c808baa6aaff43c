// Colours that stand for numbers, in plots and in pictures of encodings.
#pragma once

#include <cstddef>

#include "core/vec.h"

namespace prt::image {

/// Blue, cyan, green, yellow, red over t in [0, 1], the scale of [Sloan03] Figure 4; clamped.
Vec3 heat_color(float t);

/// Of a cluster: depends on its number alone, neighbours in number differ.
Vec3 cluster_color(std::size_t cluster);

}  // namespace prt::image
