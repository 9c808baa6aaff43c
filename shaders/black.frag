// Black and covered: back faces stay so, as in the bake and for the path tracer; transfer knows the
// front alone.
out vec4 o_color;

void main() { o_color = vec4(0.0, 0.0, 0.0, 1.0); }
