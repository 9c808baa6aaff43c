// Uncompressed diffuse transfer [Sloan02]: radiance = t_p · l for each colour, t_p from a table of
// CHANNEL_COUNT × ROW_VECTOR_COUNT vec4 a vertex (coefficients in fours, zero padded). The light has
// as many for R, then G, then B.
#include "position.glsl"
#include "light_vectors.glsl"
#include "send_exit.glsl"

uniform sampler2D u_transfer;

void main() {
  int first = gl_VertexID * (CHANNEL_COUNT * ROW_VECTOR_COUNT);
  vec4 exit[VECTOR_COUNT];
  exit[0] = vec4(0.0);
  for (int i = 0; i < ROW_VECTOR_COUNT; ++i) {
    vec4 red = table_at(u_transfer, first + i);
#if CHANNEL_COUNT == 3
    vec4 green = table_at(u_transfer, first + ROW_VECTOR_COUNT + i);
    vec4 blue = table_at(u_transfer, first + 2 * ROW_VECTOR_COUNT + i);
#else
    vec4 green = red, blue = red;
#endif
    exit[0].rgb += vec3(dot(red, light_vector(i)), dot(green, light_vector(ROW_VECTOR_COUNT + i)),
                        dot(blue, light_vector(2 * ROW_VECTOR_COUNT + i)));
  }
  send_exit(exit);
  place_vertex();
}
