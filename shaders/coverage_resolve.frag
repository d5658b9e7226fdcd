// The resolved samples of coverage_target.cpp as a picture: colours that are weighted with alpha
// become straight ones.
uniform sampler2D resolved;  // rgb times alpha, and the fraction of samples that no face covers
uniform vec4 background;

layout(location = 0) out vec4 color;

void main() {
  vec4 value = texelFetch(resolved, ivec2(gl_FragCoord.xy), 0);
  float alpha = 1.0 - value.a * (1.0 - background.a);
  color = alpha > 0.0 ? vec4(value.rgb / alpha, alpha) : background;
}
