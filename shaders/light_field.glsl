// The samples of the light that a vertex blends: where light differs from place to place, those at
// the eight points around it of a grid over the model; else the one there is. Twin of
// runtime/light_field.h.
struct LightSample {
  int number;
  float share;
};

#if LIGHT_SAMPLE_COUNT == 8
uniform int u_grid_size;                    // points along each side
uniform vec3 u_grid_corner, u_grid_scale;  // positions to grid steps

vec3 grid_place() {
  vec3 place = (a_position - u_grid_corner) * u_grid_scale;
  return clamp(place, vec3(0.0), vec3(u_grid_size - 1));
}

LightSample light_sample(int i) {
  vec3 place = grid_place();
  ivec3 cell = min(ivec3(place), ivec3(u_grid_size - 2)), side = ivec3(i, i >> 1, i >> 2) & 1;
  vec3 high = place - vec3(cell), shares = mix(1.0 - high, high, vec3(side));
  ivec3 at = cell + side;
  return LightSample((at.z * u_grid_size + at.y) * u_grid_size + at.x,
                     shares.x * shares.y * shares.z);
}

// Of the sample at a place in the grid; 0 unless the vertex blends it.
float share_of_sample(vec3 place) {
  vec3 shares = max(1.0 - abs(grid_place() - place), 0.0);
  return shares.x * shares.y * shares.z;
}
#else
LightSample light_sample(int i) { return LightSample(0, 1.0); }

float share_of_sample(vec3 place) { return 1.0; }
#endif
