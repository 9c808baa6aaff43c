// Linear radiance as interpolated, negative values included; alpha is coverage; back faces are black.
centroid in vec3 v_radiance;

out vec4 o_color;

void main() { o_color = vec4(gl_FrontFacing ? v_radiance : vec3(0.0), 1.0); }
