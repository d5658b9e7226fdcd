// Triangle windows (arXiv 2505.19175) as the triangles themselves. With the corners' homogeneous
// image points Q_k and N_k = Q_i x Q_j, W = sum_k w_k |N_k.xy|, component k of `distances` is
// W / |N_k.xy| at vertex k and 0 elsewhere. Times gl_FragCoord.w, the interpolated components are the
// distances from the edges over the inradius. No division by a w near 0 occurs, so the hardware
// may clip the triangle (docs/numerics.md, W14).
#include "eye.glsl"
#include "splat_kernel_texels.glsl"
#include "splat_order.glsl"
#include "splat_projected.glsl"

uniform mat4 clip_from_camera;  // rotation and projection, no translation
uniform vec2 half_size;         // of the image, in pixels
uniform sampler2D colors;

out vec3 distances;
flat out vec4 color;
flat out float sigma;

void main() {
  uint splat = ordered_splat();
  int corner = splat_corner();
  vec4 texels[3];
  vec3 corners[3];
  for (int i = 0; i < 3; ++i) {
    texels[i] = kernel_texel(splat, i);
    corners[i] = (texels[i].xyz - eye_high) - eye_low;
  }
  float lengths[3];  // of N_k.xy
  float total = 0.0;
  vec4 clip = vec4(0.0);
  for (int k = 0; k < 3; ++k) {
    int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    vec4 point = clip_from_camera * vec4(corners[i], 1.0);
    // The difference of the stored positions is more exact than that of the image points.
    vec4 edge = clip_from_camera * vec4(texels[j].xyz - texels[i].xyz, 0.0);
    vec2 normal = half_size.yx * vec2(point.y * edge.w - point.w * edge.y,
                                      point.w * edge.x - point.x * edge.w);
    lengths[k] = length(normal);
    vec4 opposite = clip_from_camera * vec4(corners[k], 1.0);
    total += opposite.w * lengths[k];
    if (k == corner) clip = opposite;
  }
  color = texelFetch(colors, projected_position(splat), 0);
  sigma = texels[0].w;
  distances = vec3(0.0);
  float own = corner == 0 ? lengths[0] : corner == 1 ? lengths[1] : lengths[2];
  // Behind the eye, or without area in the image.
  bool visible = total > 0.0 && min(lengths[0], min(lengths[1], lengths[2])) > 0.0;
  float own_distance = visible ? total / own : 0.0;
  if (corner == 0) distances.x = own_distance;
  if (corner == 1) distances.y = own_distance;
  if (corner == 2) distances.z = own_distance;
  gl_Position = visible ? clip : nowhere;
}
