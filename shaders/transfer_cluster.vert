// Compressed transfer of one cluster [Sloan03] §6.2: its constants in uniform registers. A vertex of
// another cluster adds nothing, so that the chunks of all clusters, blended additively, are a linear
// partition of unity over the triangles between clusters.
#include "position.glsl"

layout(location = 1) in uint a_cluster;
WEIGHT_INPUTS

uniform int u_cluster;
uniform vec4 u_constants[COMPONENT_COUNT + 1];  // t_i·l, rgb

centroid out vec3 v_radiance;

void main() {
  float alpha = int(a_cluster) == u_cluster ? 1.0 : 0.0;
  v_radiance = alpha * u_constants[0].rgb;
#define ADD_TERM(i, weight) v_radiance += (alpha * weight) * u_constants[1 + i].rgb;
  FOR_EACH_WEIGHT(ADD_TERM)
  place_vertex();
}
