// Compressed transfer in one draw [Sloan03] §6: exit values = M_0 l + Σ_i w_i (M_i l), the
// constants M_i l of the vertex's cluster fetched from a table. Clusters may have different numbers
// of vectors, which the paper's hardware could not draw.
#include "position.glsl"
#include "light_field.glsl"
#include "send_exit.glsl"
#include "weights.glsl"

uniform sampler2D u_constants;  // light sample by light sample, pass by pass, cluster by cluster
uniform int u_sample_size;      // constants of a light sample
uniform int u_first_vector;     // of the pass, or of the colour

void add(inout vec4 exit[VECTOR_COUNT], int constant, float weight) {
  for (int j = 0; j < VECTOR_COUNT; ++j)
    exit[j] += weight * table_at(u_constants, u_first_vector + constant * CONSTANT_STRIDE + j);
}

void main() {
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = vec4(0.0);
  for (int k = 0; k < LIGHT_SAMPLE_COUNT; ++k) {
    LightSample light = light_sample(k);
    int first = light.number * u_sample_size + int(a_first_constant);
    add(exit, first, light.share);
#define ADD_TERM(i, weight) add(exit, first + 1 + i, light.share * weight);
    FOR_EACH_WEIGHT(ADD_TERM)
  }
  send_exit(exit);
  place_vertex();
}
