// Marks pixels without a triangle of which most neighbours have one.
uniform usampler2D visible;  // written by visibility.frag
uniform vec4 hole_color;

layout(location = 0) out vec4 color;

bool covered(ivec2 pixel) {
  return texelFetch(visible, pixel, 0).x != NO_FACE;
}

void main() {
  ivec2 middle = ivec2(gl_FragCoord.xy), last = textureSize(visible, 0) - 1;
  if (covered(middle)) discard;
  int count = 0;
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x)
      count += int(covered(clamp(middle + ivec2(x, y), ivec2(0), last)));
  if (count <= 12) discard;
  color = hole_color;
}
