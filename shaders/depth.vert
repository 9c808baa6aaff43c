// The pass that fills the depth buffer before additive blending.
#include "position.glsl"

void main() { place_vertex(); }
