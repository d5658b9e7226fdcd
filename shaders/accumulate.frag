// Adds an image to a sum of images: colours times alpha, and alpha.
uniform sampler2D image;
uniform sampler2D sum;

layout(location = 0) out vec4 total;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 value = texelFetch(image, pixel, 0);
  total = texelFetch(sum, pixel, 0) + vec4(value.rgb * value.a, value.a);
}
