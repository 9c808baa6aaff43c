// Coefficients of the light at a vertex, LIGHT_VECTOR_COUNT vec4: the same for all in registers, or
// blended of the samples around the vertex.
#include "light_field.glsl"
#include "table.glsl"

#if LIGHT_SAMPLE_COUNT == 1
uniform vec4 u_light[LIGHT_VECTOR_COUNT];

vec4 light_vector(int i) { return u_light[i]; }
#else
uniform sampler2D u_lights;  // sample by sample

vec4 light_vector(int i) {
  vec4 sum = vec4(0.0);
  for (int k = 0; k < LIGHT_SAMPLE_COUNT; ++k) {
    LightSample light = light_sample(k);
    sum += light.share * table_at(u_lights, light.number * LIGHT_VECTOR_COUNT + i);
  }
  return sum;
}
#endif
