// One triangle that covers the viewport; draw 3 vertices without attributes.
out vec2 v_ndc;

void main() {
  v_ndc = vec2(float((gl_VertexID & 1) * 4 - 1), float((gl_VertexID & 2) * 2 - 1));
  gl_Position = vec4(v_ndc, 0.0, 1.0);
}
