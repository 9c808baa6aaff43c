// Compressed transfer in one draw [Sloan03] §6: exit values = M_0 l + Σ_i w_i (M_i l), the
// constants M_i l of the vertex's cluster fetched from a table. Clusters may have different numbers
// of vectors, which the paper's hardware could not draw.
#include "position.glsl"
#include "send_exit.glsl"
#include "weights.glsl"

uniform sampler2D u_constants;   // pass by pass, cluster by cluster
uniform int u_first_constant;  // of the pass

void main() {
  int first = (u_first_constant + int(a_first_constant)) * VECTOR_COUNT;
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = table_at(u_constants, first + j);
#define ADD_TERM(i, weight) \
  for (int j = 0; j < VECTOR_COUNT; ++j)  \
    exit[j] += weight * table_at(u_constants, first + (1 + i) * VECTOR_COUNT + j);
  FOR_EACH_WEIGHT(ADD_TERM)
  send_exit(exit);
  place_vertex();
}
