// Functions of the hemisphere, evaluated (runtime/view_basis.h): polynomials of z times real and
// imaginary parts of (x + iy)^m.
void functions_towards(vec3 direction, out vec4 y[COLOR_VECTOR_COUNT]) {
  float z = max(direction.z, 0.0), zz = z * z;
  vec2 p[BAND_COUNT];
  p[0] = vec2(1.0, 0.0);
  vec2 once = direction.z > 0.0 ? direction.xy : direction.xy / max(length(direction.xy), 1e-6);
  for (int m = 1; m < BAND_COUNT; ++m)
    p[m] = vec2(once.x * p[m - 1].x - once.y * p[m - 1].y,
                once.x * p[m - 1].y + once.y * p[m - 1].x);
#define EVALUATE(i, functions) y[i] = functions;
  FOR_EACH_FUNCTIONS(EVALUATE)
}
