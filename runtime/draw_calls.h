// What the ways of drawing a model share.
#pragma once

#include <cstddef>

#include "gl/objects.h"

namespace prt::runtime {

/// Positions at location 0, and indices.
gl::VertexArray array_with_positions(const gl::Buffer& positions, const gl::Buffer& indices);

/// `count` indices of the bound array from number `first` on.
void draw_triangles(std::size_t first, std::size_t count);

}  // namespace prt::runtime
