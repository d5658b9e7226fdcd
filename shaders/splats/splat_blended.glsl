// Output of a splat's fragment: premultiplied, for blending front to back.
layout(location = 0) out vec4 blended;

vec4 blended_color(vec3 color, float alpha) {
  alpha = min(alpha, MAX_ALPHA);
  // A comparison that is false for NaN. Zero instead of discard, which is slower on software
  // devices.
  return alpha >= MIN_ALPHA ? vec4(color * alpha, alpha) : vec4(0.0);
}
