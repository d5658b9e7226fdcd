// Blended splats over the colours behind them, or over the background.
uniform sampler2D splats;  // premultiplied
uniform float color_unit;  // the value of colour 1 in `splats`
#if OVER_COLORS
uniform sampler2D behind;  // not premultiplied
#else
uniform vec4 background;  // not premultiplied
#endif

layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 front = texelFetch(splats, pixel, 0);
#if OVER_COLORS
  vec4 back = texelFetch(behind, pixel, 0);
#else
  vec4 back = background;
#endif
  front.rgb /= color_unit;
  float through = 1.0 - front.a;
  float alpha = front.a + through * back.a;
  // Where nothing is visible, the colour behind stays, as for soups.
  color = alpha > 0.0 ? vec4((front.rgb + through * back.a * back.rgb) / alpha, alpha) : back;
}
