// A colour given with each vertex: cluster colours, error heat map.
#include "position.glsl"

layout(location = 1) in vec3 a_color;

centroid out vec3 v_color;

void main() {
  v_color = a_color;
  place_vertex();
}
