// Exit values as they were summed when the light changed (runtime/exit_buffer.h).
#include "position.glsl"
#include "send_exit.glsl"
#include "table.glsl"

layout(location = 1) in uint a_place;  // among the captured vertices

uniform sampler2D u_exit;  // colour by colour, vertex by vertex
uniform int u_color_size;  // vec4 from a colour to the next
uniform int u_first;       // of the pass

void main() {
  vec4 exit[VECTOR_COUNT];
  for (int color = 0; color < PASS_COLOR_COUNT; ++color) {
    int first = u_first + color * u_color_size + int(a_place) * COLOR_VECTOR_COUNT;
    for (int j = 0; j < COLOR_VECTOR_COUNT; ++j)
      exit[color * COLOR_VECTOR_COUNT + j] = table_at(u_exit, first + j);
  }
  send_exit(exit);
  place_vertex();
}
