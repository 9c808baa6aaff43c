// Radiance towards the eye: interpolated coefficients of exit radiance dotted with the functions'
// values y(v) [Sloan03] §6.2. Directions below the horizon, at outlines where interpolated normals
// turn away from the eye, count as at the rim: the functions go on below it, but nothing is known
// there. Negative values stay; alpha is coverage.
#ifdef FOR_EACH_FUNCTIONS
#include "view_polynomials.glsl"
#else
#include "hemisphere_map.glsl"
#endif

centroid in vec3 v_view;
centroid in vec4 v_exit[VECTOR_COUNT];

out vec4 o_color;

void main() {
  vec4 y[COLOR_VECTOR_COUNT];
  functions_towards(normalize(v_view), y);
  vec3 radiance = vec3(0.0);
  for (int j = 0; j < COLOR_VECTOR_COUNT; ++j) {
#if PASS_COLOR_COUNT == 3
    radiance += vec3(dot(v_exit[j], y[j]), dot(v_exit[COLOR_VECTOR_COUNT + j], y[j]),
                     dot(v_exit[2 * COLOR_VECTOR_COUNT + j], y[j]));
#else
    radiance += dot(v_exit[j], y[j]);
#endif
  }
  o_color = vec4(radiance, 1.0);
}
