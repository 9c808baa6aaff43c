// Display colour of linear radiance; twins of runtime/shading.h, which has the sources.

// Khronos PBR Neutral.
vec3 tone_map(vec3 color) {
  const float kStart = 0.8 - 0.04, kDesaturation = 0.15;
  color = max(color, vec3(0.0));
  float low = min(color.r, min(color.g, color.b));
  color -= low < 0.08 ? low - 6.25 * low * low : 0.04;
  float peak = max(color.r, max(color.g, color.b));
  if (peak < kStart) return color;
  float d = 1.0 - kStart;
  float new_peak = 1.0 - d * d / (peak + d - kStart);
  float gray = 1.0 - 1.0 / (kDesaturation * (peak - new_peak) + 1.0);
  return mix(color * (new_peak / peak), vec3(new_peak), gray);
}

vec3 srgb_encode(vec3 color) {
  color = clamp(color, 0.0, 1.0);
  return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color,
             vec3(lessThanEqual(color, vec3(0.0031308))));
}
