// Where a vertex lands. The same expression in every pass and invariant, so that depths drawn by
// one pass equal those of another bit by bit.
layout(location = 0) in vec3 a_position;

uniform mat4 u_clip_from_world;

invariant gl_Position;

void place_vertex() { gl_Position = u_clip_from_world * vec4(a_position, 1.0); }
