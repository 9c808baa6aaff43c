// Black and covered: what clusters are then added to.
out vec4 o_color;

void main() { o_color = vec4(0.0, 0.0, 0.0, 1.0); }
