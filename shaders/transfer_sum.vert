// Compressed transfer of the vertices of one cluster, to be kept: exit values = M_0 l + Σ_i w_i (M_i l)
// [Sloan03] §6. All constants are the cluster's, in uniform registers that the compiler knows.
#include "send_exit.glsl"
#include "weights.glsl"

uniform vec4 u_constants[CONSTANT_COUNT * VECTOR_COUNT];  // M_i l

void add(inout vec4 exit[VECTOR_COUNT], int constant, float weight) {
  for (int j = 0; j < VECTOR_COUNT; ++j)
    exit[j] += weight * u_constants[constant * VECTOR_COUNT + j];
}

void main() {
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = u_constants[j];
#define ADD_TERM(i, weight) add(exit, 1 + i, weight);
  FOR_EACH_WEIGHT(ADD_TERM)
  send_exit(exit);
  gl_Position = vec4(0.0);
}
