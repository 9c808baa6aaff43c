// Functions on the hemisphere from control points of bicubic B-splines on its parabolic map
// (runtime/hemisphere_map.h): sixteen of them by four fetches, since a bilinear fetch between two
// control points weighs them as it is placed.
uniform sampler2DArray u_functions;

struct MapPlace {
  vec2 low, high;  // where to fetch: left and right, below and above
  vec2 share;      // of the fetches at `high`
};

MapPlace map_place(vec3 direction) {
  vec2 p = direction.xy / max(direction.z > 0.0 ? 1.0 + direction.z : length(direction.xy), 1e-6);
  float size = float(textureSize(u_functions, 0).x);
  vec2 texel = 1.0 + (0.5 + 0.5 * p) * (size - 3.0);
  vec2 corner = floor(texel), f = texel - corner, g = 1.0 - f;
  vec2 before = g * g * g / 6.0, after = f * f * f / 6.0;  // of the outer control points
  vec2 share = (f * (3.0 + f * (3.0 - 2.0 * f)) + 1.0) / 6.0;
  return MapPlace((corner + 0.5 - before / (1.0 - share)) / size,
                  (corner + 1.5 + after / share) / size, share);
}

vec4 functions_at(MapPlace place, float layer) {
  vec2 a = place.low, b = place.high;
  return mix(mix(texture(u_functions, vec3(a, layer)),
                 texture(u_functions, vec3(b.x, a.y, layer)), place.share.x),
             mix(texture(u_functions, vec3(a.x, b.y, layer)),
                 texture(u_functions, vec3(b, layer)), place.share.x),
             place.share.y);
}

void functions_towards(vec3 direction, out vec4 y[COLOR_VECTOR_COUNT]) {
  MapPlace place = map_place(direction);
  for (int j = 0; j < COLOR_VECTOR_COUNT; ++j) y[j] = functions_at(place, float(j));
}
