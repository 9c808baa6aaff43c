// Uncompressed glossy transfer [Sloan02, Lehtinen and Kautz 2003]: exit values = M_p l. A vertex's
// matrix is fetched whole from a table: CHANNEL_COUNT × COEFFICIENT_COUNT columns of
// COLOR_VECTOR_COUNT vec4.
#include "position.glsl"
#include "send_exit.glsl"
#include "table.glsl"

uniform sampler2D u_transfer;
uniform vec4 u_light[COEFFICIENT_COUNT];  // R, G, B
uniform int u_pass;                       // the colour, where a pass draws but one

void main() {
  const int kMatrixSize = COEFFICIENT_COUNT * COLOR_VECTOR_COUNT;
  const int kColorStride = CHANNEL_COUNT == 3 ? kMatrixSize : 0;
  int first = gl_VertexID * (CHANNEL_COUNT * kMatrixSize);
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = vec4(0.0);
  for (int i = 0; i < COEFFICIENT_COUNT; ++i, first += COLOR_VECTOR_COUNT)
    for (int j = 0; j < COLOR_VECTOR_COUNT; ++j) {
#if PASS_COLOR_COUNT == 3
      for (int color = 0; color < 3; ++color)
        exit[color * COLOR_VECTOR_COUNT + j] +=
            u_light[i][color] * table_at(u_transfer, first + color * kColorStride + j);
#else
      exit[j] += u_light[i][u_pass] * table_at(u_transfer, first + u_pass * kColorStride + j);
#endif
    }
  send_exit(exit);
  place_vertex();
}
