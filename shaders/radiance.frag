// Linear radiance as interpolated, negative values included; alpha is coverage. Back faces are
// black, as in the bake and for the path tracer: transfer knows the front alone.
centroid in vec3 v_radiance;

out vec4 o_color;

void main() { o_color = vec4(gl_FrontFacing ? v_radiance : vec3(0.0), 1.0); }
