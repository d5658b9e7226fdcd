// Checks, which programs show behind transparent images.
uniform float side;  // of a check, in pixels

layout(location = 0) out vec4 color;

void main() {
  vec2 check = floor(gl_FragCoord.xy / side);
  // Greys that differ from each other and from black and white.
  color = vec4(vec3(mod(check.x + check.y, 2.0) < 0.5 ? 0.55 : 0.7), 1.0);
}
