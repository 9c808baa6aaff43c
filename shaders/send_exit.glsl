// What a vertex hands to its pixels: VECTOR_COUNT vec4 of exit values (runtime/exit_layout.h).
// Diffuse ones are the colour itself. Glossy ones, PASS_COLOR_COUNT colours of COLOR_VECTOR_COUNT
// vec4 each, are coefficients of exit radiance in the vertex's frame, with which goes the direction
// to the eye [Sloan03] §6.2.
//
// Frames of neighbours need not agree: tangents jump at seams of texture coordinates, where they
// are mirrored, and where meshes without tangents take another world axis. Before coefficients are
// interpolated they are therefore turned about the normal into a frame that varies smoothly: the
// camera's, moved by the least rotation that takes the direction from target to eye to the normal.
// A turn by angle a acts on the coefficients of (l,m) and (l,-m) as a turn by m a of a plane.
//
// Exit values that are to be kept (runtime/exit_buffer.h) are captured as they are.
#ifdef CAPTURE
out vec4 v_exit[VECTOR_COUNT];

void send_exit(vec4 exit[VECTOR_COUNT]) { v_exit = exit; }
#elif defined(GLOSSY)
layout(location = 14) in vec3 a_normal;
layout(location = 15) in vec4 a_tangent;  // orthogonal to the normal; w: handedness

uniform vec3 u_eye, u_right, u_backward;  // of the camera

centroid out vec3 v_view;  // to the eye, in the smooth frame
centroid out vec4 v_exit[VECTOR_COUNT];

void send_exit(vec4 exit[VECTOR_COUNT]) {
  vec3 z = a_normal, bitangent = cross(z, a_tangent.xyz);
  float lean = max(1.0 + dot(u_backward, z), 1e-6);  // 0 only where the surface faces away
  vec3 x = u_right - (dot(u_right, z) / lean) * (u_backward + z);
  vec3 view = u_eye - a_position;
  v_view = vec3(dot(x, view), dot(cross(z, x), view), dot(z, view));

  vec2 angle = vec2(dot(x, a_tangent.xyz), dot(x, bitangent));  // of x: cosine and sine
  mat2 once = mat2(angle.x, -angle.y, angle.y, angle.x), rotation = mat2(1.0);
  mat2 mirror = mat2(1.0, 0.0, 0.0, a_tangent.w);
  mat2 turns[BAND_COUNT];
  turns[0] = rotation;
  for (int m = 1; m < BAND_COUNT; ++m) {
    rotation = once * rotation;
    turns[m] = rotation * mirror;
  }
  for (int j = 0; j < VECTOR_COUNT; j += COLOR_VECTOR_COUNT) {
#define TURN(i, m, n) v_exit[j + i] = vec4(turns[m] * exit[j + i].xy, turns[n] * exit[j + i].zw);
    FOR_EACH_VECTOR(TURN)
  }
}
#else
centroid out vec3 v_radiance;

void send_exit(vec4 exit[VECTOR_COUNT]) { v_radiance = exit[0].rgb; }
#endif
