// Compressed transfer of one supercluster [Sloan03] §6.2: the constants of all its clusters in
// uniform registers, of which a vertex uses its cluster's. A vertex of another supercluster adds
// nothing, so that the chunks of all, blended additively, are a linear partition of unity over the
// triangles between them. So are the samples of a light that varies, added up alike.
#include "position.glsl"
#include "light_field.glsl"
#include "send_exit.glsl"
#include "weights.glsl"

uniform int u_first_constant, u_constant_count;           // of the supercluster
uniform vec4 u_constants[CONSTANT_COUNT * VECTOR_COUNT];  // M_i l
uniform vec3 u_light_sample;                              // its place in the grid

void add(inout vec4 exit[VECTOR_COUNT], int constant, float weight) {
  for (int j = 0; j < VECTOR_COUNT; ++j)
    exit[j] += weight * u_constants[constant * VECTOR_COUNT + j];
}

void main() {
  int first = int(a_first_constant) - u_first_constant;
  bool is_member = first >= 0 && first < u_constant_count;
  float alpha = is_member ? share_of_sample(u_light_sample) : 0.0;
  first = is_member ? first : 0;
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = vec4(0.0);
  add(exit, first, alpha);
#define ADD_TERM(i, weight) add(exit, first + 1 + i, alpha * weight);
  FOR_EACH_WEIGHT(ADD_TERM)
  send_exit(exit);
  place_vertex();
}
