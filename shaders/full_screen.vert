// One triangle over the whole window at the depth of the background (ndc z), so that the depth test
// can reject every pixel that no face covers.
uniform float background_depth;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, background_depth, 1.0);
}
