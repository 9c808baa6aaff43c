#include "runtime/draw_calls.h"

#include <epoxy/gl.h>

#include <cstdint>

namespace prt::runtime {

gl::VertexArray array_with_positions(const gl::Buffer& positions, const gl::Buffer& indices) {
  gl::VertexArray array;
  array.set_floats(0, positions, 3, sizeof(Vec3), 0);
  array.set_indices(indices);
  return array;
}

void draw_triangles(std::size_t first, std::size_t count) {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
}

}  // namespace prt::runtime
