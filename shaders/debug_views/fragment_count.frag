// One more fragment of this pixel: what is drawn adds up in steps of 8 bits.
layout(location = 0) out vec4 color;

void main() { color = vec4(1.0 / 255.0); }
