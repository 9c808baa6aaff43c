// Linear radiance as interpolated, negative values included; alpha is coverage.
centroid in vec3 v_radiance;

out vec4 o_color;

void main() { o_color = vec4(v_radiance, 1.0); }
