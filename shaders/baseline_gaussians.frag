in vec2 deviations;
flat in vec4 color;

layout(location = 0) out vec4 blended;  // premultiplied

void main() {
  float power = -0.5 * dot(deviations, deviations);
  if (power < -4.0) discard;
  float alpha = color.a * exp(power);
  blended = vec4(alpha * color.rgb, alpha);
}
