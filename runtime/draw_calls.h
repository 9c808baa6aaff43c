// What the ways of drawing a model share.
#pragma once

#include <cstddef>
#include <functional>

#include "core/vec.h"
#include "gl/objects.h"

namespace prt::runtime {

/// What shaders know of the camera, in the world.
struct Viewpoint {
  Matrix4 clip_from_world;
  Vec3 eye, right, backward;  ///< camera::Camera::axes()
};

/// Positions at location 0, and indices.
gl::VertexArray array_with_positions(const gl::Buffer& positions, const gl::Buffer& indices);

/// `count` indices of the bound array from number `first` on.
void draw_triangles(std::size_t first, std::size_t count);

/// Calls draw(pass) for each pass, which can write its colours only: all, or of three passes one
/// each, coverage staying as it is.
void draw_passes(int pass_count, const std::function<void(int pass)>& draw);

}  // namespace prt::runtime
