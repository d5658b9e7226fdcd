// The splat of a vertex: three vertices a splat, in the order of blending.
uniform usampler2D order;

uint ordered_splat() {
  int i = gl_VertexID / 3;
  return texelFetch(order, ivec2(i % ORDER_COLUMNS, i / ORDER_COLUMNS), 0).x;
}

int splat_corner() { return gl_VertexID - 3 * (gl_VertexID / 3); }

// A vertex of a triangle that covers no pixel.
const vec4 nowhere = vec4(0.0, 0.0, 2.0, 1.0);
