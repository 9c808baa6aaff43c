// Radiance towards the eye: interpolated coefficients of exit radiance dotted with the functions'
// values y(v) from a map of the hemisphere [Sloan03] §6.2. Negative values stay; alpha is coverage.
#include "hemisphere_map.glsl"

centroid in vec3 v_view;
centroid in vec4 v_exit[VECTOR_COUNT];

out vec4 o_color;

void main() {
  MapPlace place = map_place(normalize(v_view));
  vec3 radiance = vec3(0.0);
  for (int j = 0; j < COLOR_VECTOR_COUNT; ++j) {
    vec4 y = functions_at(place, float(j));
#if PASS_COLOR_COUNT == 3
    radiance += vec3(dot(v_exit[j], y), dot(v_exit[COLOR_VECTOR_COUNT + j], y),
                     dot(v_exit[2 * COLOR_VECTOR_COUNT + j], y));
#else
    radiance += dot(v_exit[j], y);
#endif
  }
  o_color = vec4(radiance, 1.0);
}
