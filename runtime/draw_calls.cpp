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

void draw_passes(int pass_count, const std::function<void(int pass)>& draw) {
  const auto mask = [](bool writable) -> GLboolean { return writable ? GL_TRUE : GL_FALSE; };
  for (int pass = 0; pass < pass_count; ++pass) {
    const bool all = pass_count == 1;
    glColorMask(mask(all || pass == 0), mask(all || pass == 1), mask(all || pass == 2), mask(all));
    draw(pass);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace prt::runtime
