// The window's panels: positions in points from the upper left corner.
uniform vec2 origin, extent;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 coordinates;
layout(location = 2) in vec4 tint;

out vec2 at;
out vec4 shade;

void main() {
  at = coordinates;
  shade = tint;
  vec2 ndc = 2.0 * (position - origin) / extent - 1.0;
  gl_Position = vec4(ndc.x, -ndc.y, 0.0, 1.0);
}
