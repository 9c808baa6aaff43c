// Element of a one-dimensional array that is kept in the rows of a texture (gl::Table).
vec4 table_at(sampler2D table, int index) {
  int width = textureSize(table, 0).x;
  return texelFetch(table, ivec2(index % width, index / width), 0);
}
