// Radiance of a latitude-longitude map, bilinear; twin of image::environment_radiance. Texels are
// fetched and mixed here because filtering hardware interpolates in steps of 1/256, which bands
// when a bright map is magnified.
vec3 environment_radiance(sampler2D map, vec3 direction) {
  const float kPi = 3.14159265358979;
  ivec2 size = textureSize(map, 0);
  bool pole = direction.x == 0.0 && direction.z == 0.0;  // where atan(0, 0) is undefined
  float u = pole ? 0.5 : 0.5 - atan(direction.x, direction.z) / (2.0 * kPi);
  float v = 0.5 - atan(direction.y, length(direction.xz)) / kPi;
  vec2 texel = vec2(u, v) * vec2(size) - 0.5;
  vec2 corner = floor(texel), f = texel - corner;
  int x0 = (int(corner.x) + size.x) % size.x, x1 = (x0 + 1) % size.x;
  int y0 = clamp(int(corner.y), 0, size.y - 1), y1 = min(int(corner.y) + 1, size.y - 1);
  return mix(mix(texelFetch(map, ivec2(x0, y0), 0), texelFetch(map, ivec2(x1, y0), 0), f.x),
             mix(texelFetch(map, ivec2(x0, y1), 0), texelFetch(map, ivec2(x1, y1), 0), f.x), f.y)
      .rgb;
}
