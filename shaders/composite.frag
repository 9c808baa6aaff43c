// Puts the background behind what was drawn and, for a screen, develops the result.
#include "environment.glsl"
#include "tone_map.glsl"

in vec2 v_ndc;

uniform sampler2D u_scene;        // linear, premultiplied by coverage
uniform sampler2D u_environment;  // latitude-longitude
uniform int u_background;         // 0: none, 1: colour, 2: environment
uniform vec3 u_background_color;
uniform vec3 u_ray_right, u_ray_up, u_ray_forward;  // in the environment's frame
uniform int u_output;                               // 0: linear, 1: sRGB, 2: tone mapped sRGB
uniform float u_exposure;                           // factor

out vec4 o_color;

vec3 background() {
  if (u_background == 0) return vec3(0.0);
  if (u_background == 1) return u_background_color;
  vec3 ray = u_ray_forward + v_ndc.x * u_ray_right + v_ndc.y * u_ray_up;
  return environment_radiance(u_environment, normalize(ray));
}

void main() {
  o_color = texelFetch(u_scene, ivec2(gl_FragCoord.xy), 0);
  if (o_color.a < 1.0) o_color.rgb += (1.0 - o_color.a) * background();
  if (u_output == 2) o_color.rgb = tone_map(u_exposure * o_color.rgb);
  if (u_output != 0) o_color = vec4(srgb_encode(o_color.rgb), 1.0);
}
