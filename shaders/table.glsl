// Element of a one-dimensional array that is kept in the rows of a texture (gl::Table), 2048 a row.
vec4 table_at(sampler2D table, int index) {
  return texelFetch(table, ivec2(index & 2047, index >> 11), 0);
}
