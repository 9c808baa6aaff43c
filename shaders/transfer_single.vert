// Compressed transfer in one draw [Sloan03] §6: radiance = t_0·l + Σ_i w_i (t_i·l), the constants
// t_i·l of the vertex's cluster fetched from a table. The loader defines COMPONENT_COUNT, the
// attributes WEIGHT_INPUTS and the unrolled loop FOR_EACH_WEIGHT(F) = F(0, w_0) F(1, w_1) …
#include "position.glsl"
#include "table.glsl"

layout(location = 1) in uint a_cluster;
WEIGHT_INPUTS

uniform sampler2D u_constants;  // cluster-major, COMPONENT_COUNT + 1 each, rgb

centroid out vec3 v_radiance;

void main() {
  int first = int(a_cluster) * (COMPONENT_COUNT + 1);
  v_radiance = table_at(u_constants, first).rgb;
#define ADD_TERM(i, weight) v_radiance += weight * table_at(u_constants, first + 1 + i).rgb;
  FOR_EACH_WEIGHT(ADD_TERM)
  place_vertex();
}
