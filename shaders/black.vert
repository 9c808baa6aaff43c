// A vertex whose place is all that matters.
#include "position.glsl"

void main() { place_vertex(); }
