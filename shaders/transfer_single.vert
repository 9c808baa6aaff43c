// Compressed transfer in one draw [Sloan03] §6: radiance = t_0·l + Σ_i w_i (t_i·l), the constants
// t_i·l of the vertex's cluster fetched from a table. Clusters may have different numbers of
// vectors, which the paper's hardware could not draw.
#include "position.glsl"
#include "weights.glsl"

uniform sampler2D u_constants;  // cluster by cluster, rgb

centroid out vec3 v_radiance;

void main() {
  int first = int(a_first_constant);
  v_radiance = table_at(u_constants, first).rgb;
#define ADD_TERM(i, weight) v_radiance += weight * table_at(u_constants, first + 1 + i).rgb;
  FOR_EACH_WEIGHT(ADD_TERM)
  place_vertex();
}
