// Where the constants of a vertex's cluster are, t_0·l and then each t_i·l, and its weights. The
// loader defines either ADAPTIVE, when clusters have different numbers of vectors: weights are then
// fetched from a table; or the attributes WEIGHT_INPUTS and the unrolled loop FOR_EACH_WEIGHT(F) =
// F(0, w_0) F(1, w_1) …, because GLSL cannot index attributes.
#include "table.glsl"

layout(location = 1) in uint a_first_constant;

#ifdef ADAPTIVE
layout(location = 2) in uvec2 a_weights;  // the first one, and how many
uniform sampler2D u_weights;              // in fours

float weight_at(int i) {
  int at = int(a_weights.x) + i;
  return table_at(u_weights, at / 4)[at % 4];
}

#define FOR_EACH_WEIGHT(F) for (int i = 0; i < int(a_weights.y); ++i) { F(i, weight_at(i)) }
#else
WEIGHT_INPUTS
#endif
