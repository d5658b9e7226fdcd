// The edges of triangles, LINE_PIXELS wide on the inner side, over the previous colours. There is
// no alpha test: a cut-out triangle is outlined completely.
#include "face_corners.glsl"

flat in uint face;

layout(location = 0) out vec4 color;

void main() {
  if (pixels_to_edge(face, gl_FragCoord.xy) > LINE_PIXELS) discard;
  color = vec4(LINE_COLOR, 1.0);
}
