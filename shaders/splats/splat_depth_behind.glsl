// The view depth of the soups behind a pixel, for splats whose depth differs from pixel to pixel.
uniform sampler2D depth_texture;
uniform vec2 depth_of_z;       // clip z of the view's z: depth_of_z.x * z + depth_of_z.y
uniform vec2 ndc_from_stored;  // factor and summand
uniform float far_stored;      // the stored depth of pixels without a soup

const float infinity = 3e38;

float depth_behind() {
  float stored = texelFetch(depth_texture, ivec2(gl_FragCoord.xy), 0).r;
  if (stored == far_stored) return infinity;
  return depth_of_z.y / (stored * ndc_from_stored.x + ndc_from_stored.y + depth_of_z.x);
}
