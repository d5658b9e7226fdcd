// The mean of the images in a sum of accumulate.frag.
uniform sampler2D sum;
uniform float share;      // of each image
uniform vec4 background;  // for pixels that are transparent in all of them

layout(location = 0) out vec4 color;

void main() {
  vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
  color = total.a > 0.0 ? vec4(total.rgb / total.a, total.a * share) : vec4(background.rgb, 0.0);
}
