// Second pass of the baseline, a reimplementation of the published DiffSoup viewer: evaluates the
// network on every pixel of the window, with weights in mat4 uniforms and the view direction from
// unprojecting the near and the far plane.
uniform sampler2D target0;
uniform sampler2D target1;
uniform mat4 world_from_clip;
uniform vec2 window_size;
uniform vec4 background;

layout(location = 0) out vec4 color;

vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye);

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(target0, pixel, 0);
  vec4 b = texelFetch(target1, pixel, 0);
  vec2 ndc = gl_FragCoord.xy / window_size * 2.0 - 1.0;
  vec4 near = world_from_clip * vec4(ndc, -1.0, 1.0);
  vec4 far = world_from_clip * vec4(ndc, 1.0, 1.0);
  vec3 to_eye = normalize(near.xyz / near.w - far.xyz / far.w);
  vec3 shaded = color_mlp(a, b, to_eye);
  color = b.a < 0.5 ? background : vec4(shaded, 1.0);
}
