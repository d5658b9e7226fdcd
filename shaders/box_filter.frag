// The mean of SAMPLES_PER_AXIS x SAMPLES_PER_AXIS samples per pixel.
uniform sampler2D samples;

layout(location = 0) out vec4 color;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES_PER_AXIS;
  vec4 sum = vec4(0.0);  // colours times alpha, and alpha
  vec3 unweighted = vec3(0.0);
  for (int y = 0; y < SAMPLES_PER_AXIS; ++y)
    for (int x = 0; x < SAMPLES_PER_AXIS; ++x) {
      vec4 value = texelFetch(samples, first + ivec2(x, y), 0);
      sum += vec4(value.rgb * value.a, value.a);
      unweighted += value.rgb;
    }
  const float each = 1.0 / float(SAMPLES_PER_AXIS * SAMPLES_PER_AXIS);
  color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a * each) : vec4(unweighted * each, 0.0);
}
