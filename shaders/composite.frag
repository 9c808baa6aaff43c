// Puts the background behind what was drawn and, for a screen, develops the result.
#include "environment.glsl"
#include "tone_map.glsl"

in vec2 v_ndc;

// Linear, premultiplied by coverage.
#ifdef SAMPLES
uniform highp sampler2DMS u_scene;
uniform int u_sample_count;
#else
uniform sampler2D u_scene;
#endif
uniform sampler2D u_environment;  // latitude-longitude
uniform int u_background;         // 0: none, 1: colour, 2: environment
uniform vec3 u_background_color;
uniform vec3 u_ray_right, u_ray_up, u_ray_forward;  // in the environment's frame
uniform int u_output;                               // 0: linear, 1: sRGB, 2: tone mapped sRGB, 3: tone mapped
uniform float u_exposure;                           // factor

out vec4 o_color;

vec3 background() {
  if (u_background == 0) return vec3(0.0);
  if (u_background == 1) return u_background_color;
  vec3 ray = u_ray_forward + v_ndc.x * u_ray_right + v_ndc.y * u_ray_up;
  return environment_radiance(u_environment, normalize(ray));
}

// What is seen of linear radiance that is premultiplied by coverage, before the sRGB curve.
vec4 developed(vec4 color, vec3 behind) {
  color.rgb += (1.0 - color.a) * behind;
  if (u_output >= 2) color.rgb = tone_map(u_exposure * color.rgb);
  return color;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef SAMPLES
  // The mean of what is seen: that of radiance would show an edge of something many times as bright
  // as white without any steps between, as if it had one sample.
  vec3 behind = background();
  vec4 sum = vec4(0.0), scene = vec4(0.0), color = developed(scene, behind);
  for (int i = 0; i < u_sample_count; ++i) {
    vec4 other = texelFetch(u_scene, pixel, i);
    if (other != scene) color = developed(scene = other, behind);
    sum += color;
  }
  o_color = sum / float(u_sample_count);
#else
  vec4 scene = texelFetch(u_scene, pixel, 0);
  o_color = developed(scene, scene.a < 1.0 ? background() : vec3(0.0));
#endif
  if (u_output == 1 || u_output == 2) o_color = vec4(srgb_encode(o_color.rgb), 1.0);
}
