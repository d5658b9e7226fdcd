// Counts the fragments of a pixel: blending adds one 8-bit step for each.
layout(location = 0) out vec4 color;

void main() { color = vec4(1.0 / 255.0); }
