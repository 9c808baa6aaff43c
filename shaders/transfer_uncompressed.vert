// Uncompressed transfer [Sloan02]: radiance = t_p · l for each colour, t_p from a table of
// CHANNEL_COUNT × VECTOR_COUNT vec4 a vertex (coefficients in fours, zero padded).
#include "position.glsl"
#include "table.glsl"

uniform sampler2D u_transfer;
uniform vec4 u_light[3 * VECTOR_COUNT];  // R, G, B

centroid out vec3 v_radiance;

void main() {
  int first = gl_VertexID * (CHANNEL_COUNT * VECTOR_COUNT);
  v_radiance = vec3(0.0);
  for (int i = 0; i < VECTOR_COUNT; ++i) {
    vec4 red = table_at(u_transfer, first + i);
#if CHANNEL_COUNT == 3
    vec4 green = table_at(u_transfer, first + VECTOR_COUNT + i);
    vec4 blue = table_at(u_transfer, first + 2 * VECTOR_COUNT + i);
#else
    vec4 green = red, blue = red;
#endif
    v_radiance += vec3(dot(red, u_light[i]), dot(green, u_light[VECTOR_COUNT + i]),
                       dot(blue, u_light[2 * VECTOR_COUNT + i]));
  }
  place_vertex();
}
