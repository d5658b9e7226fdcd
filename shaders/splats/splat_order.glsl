// The splat of a vertex: three vertices a splat, in the order of blending.
#include "splat_sampled_vertex.glsl"

uniform usampler2D order;

uint ordered_splat() {
#if OUTPUT == OUTPUT_SAMPLE
  return uint(gl_VertexID / 3);  // the depth test replaces the order
#else
  int i = gl_VertexID / 3;
  return texelFetch(order, ivec2(i % ORDER_COLUMNS, i / ORDER_COLUMNS), 0).x;
#endif
}

int splat_corner() { return gl_VertexID - 3 * (gl_VertexID / 3); }

// A vertex of a triangle that covers no pixel.
const vec4 nowhere = vec4(0.0, 0.0, 2.0, 1.0);
