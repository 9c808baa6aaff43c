// Uncompressed glossy transfer [Sloan02, Lehtinen and Kautz 2003]: exit values = M_p l. A vertex's
// matrix is fetched whole from a table: CHANNEL_COUNT × LIGHT_VECTOR_COUNT columns of
// COLOR_VECTOR_COUNT vec4. The light is (R, G, B, 0) for each coefficient.
#include "position.glsl"
#include "light_vectors.glsl"
#include "send_exit.glsl"

uniform sampler2D u_transfer;
uniform int u_pass;  // the colour, where a pass draws but one

void main() {
  const int kMatrixSize = LIGHT_VECTOR_COUNT * COLOR_VECTOR_COUNT;
  const int kColorStride = CHANNEL_COUNT == 3 ? kMatrixSize : 0;
  int first = gl_VertexID * (CHANNEL_COUNT * kMatrixSize);
  vec4 exit[VECTOR_COUNT];
  for (int j = 0; j < VECTOR_COUNT; ++j) exit[j] = vec4(0.0);
  for (int i = 0; i < LIGHT_VECTOR_COUNT; ++i, first += COLOR_VECTOR_COUNT) {
    vec4 light = light_vector(i);
    for (int j = 0; j < COLOR_VECTOR_COUNT; ++j) {
#if PASS_COLOR_COUNT == 3
      for (int color = 0; color < 3; ++color)
        exit[color * COLOR_VECTOR_COUNT + j] +=
            light[color] * table_at(u_transfer, first + color * kColorStride + j);
#else
      exit[j] += light[u_pass] * table_at(u_transfer, first + u_pass * kColorStride + j);
#endif
    }
  }
  send_exit(exit);
  place_vertex();
}
