// Compressed transfer of one supercluster [Sloan03] §6.2: the constants of all its clusters in
// uniform registers, of which a vertex uses its cluster's. A vertex of another supercluster adds
// nothing, so that the chunks of all, blended additively, are a linear partition of unity over the
// triangles between them.
#include "position.glsl"
#include "send_exit.glsl"
#include "weights.glsl"

uniform int u_first_constant, u_constant_count;          // of the supercluster
uniform vec4 u_constants[CONSTANT_COUNT * VECTOR_COUNT];  // M_i l

void main() {
  int first = int(a_first_constant) - u_first_constant;
  bool is_member = first >= 0 && first < u_constant_count;
  float alpha = is_member ? 1.0 : 0.0;
  first = is_member ? first * VECTOR_COUNT : 0;
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = alpha * u_constants[first + j];
#define ADD_TERM(i, weight) \
  for (int j = 0; j < VECTOR_COUNT; ++j) \
    exit[j] += (alpha * weight) * u_constants[first + (1 + i) * VECTOR_COUNT + j];
  FOR_EACH_WEIGHT(ADD_TERM)
  send_exit(exit);
  place_vertex();
}
