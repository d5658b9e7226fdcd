// Linear interpolation between the centres of coarser samples, computed in the shader: a sampler's
// weights may have only 8 bits, and ignore alpha.
uniform sampler2D samples;
uniform vec2 samples_per_pixel;

layout(location = 0) out vec4 color;

void main() {
  // Pixels beyond the outermost centres repeat the border's samples.
  vec2 last = vec2(textureSize(samples, 0) - 1);
  vec2 at = clamp(gl_FragCoord.xy * samples_per_pixel - 0.5, vec2(0.0), last);
  ivec2 low = ivec2(at);
  ivec2 high = min(low + 1, ivec2(last));
  vec2 f = at - vec2(low);
  vec4 a = texelFetch(samples, low, 0), b = texelFetch(samples, ivec2(high.x, low.y), 0);
  vec4 c = texelFetch(samples, ivec2(low.x, high.y), 0), d = texelFetch(samples, high, 0);
  vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  vec4 alphas = weights * vec4(a.a, b.a, c.a, d.a);
  float alpha = alphas.x + alphas.y + alphas.z + alphas.w;
  // If all alphas are 0, the colours are not weighted by alpha.
  if (alpha > 0.0) weights = alphas / alpha;
  color = vec4(weights.x * a.rgb + weights.y * b.rgb + weights.z * c.rgb + weights.w * d.rgb, alpha);
}
