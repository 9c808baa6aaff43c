// Uncompressed transfer [Sloan02]: radiance = t_p · l for each colour, t_p from a table of
// CHANNEL_COUNT × VECTOR_COUNT vec4 a vertex (coefficients in fours, zero padded). The light has as
// many for R, then G, then B.
#include "position.glsl"
#include "light_vectors.glsl"

uniform sampler2D u_transfer;

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
    v_radiance += vec3(dot(red, light_vector(i)), dot(green, light_vector(VECTOR_COUNT + i)),
                       dot(blue, light_vector(2 * VECTOR_COUNT + i)));
  }
  place_vertex();
}
