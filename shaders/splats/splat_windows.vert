// Triangle windows (arXiv 2505.19175) as the triangles themselves. With the corners' homogeneous
// image points Q_k and N_k = Q_i x Q_j, W = sum_k w_k |N_k.xy|, component k of `distances` is
// W / |N_k.xy| at vertex k and 0 elsewhere. Times gl_FragCoord.w, the interpolated components are the
// distances from the edges over the inradius. No division by a w near 0 occurs, so the hardware
// may clip the triangle (docs/numerics.md, W14).
//
// Colours of corners are interpolated in the image, without perspective, for which GLSL ES has no
// qualifier: rgb and 1, both times w, are interpolated with perspective and divided. A corner behind the
// eye has weight 0; otherwise colours would grow without limit near the eye's plane.
#include "eye.glsl"
#include "splat_hidden.glsl"
#include "splat_kernel_texels.glsl"
#include "splat_measured_vertex.glsl"
#include "splat_order.glsl"
#include "splat_projected.glsl"

uniform mat4 clip_from_camera;  // rotation and projection, no translation
uniform vec2 half_size;         // of the image, in pixels
uniform sampler2D colors;

out vec3 distances;
flat out vec4 color;
flat out float sigma;
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
flat out float unit;  // layer units in one unit of w
out float weight;     // of the corners, together
#endif
#if COLORS_PER_SPLAT == 3
out vec4 weighted_color;
#endif

// Whether earlier splats hide a triangle with these corners. None if a corner is not in front.
bool is_triangle_hidden(vec4 clip[3]) {
  if (!(min(clip[0].w, min(clip[1].w, clip[2].w)) > 0.0)) return false;
  vec2 a = clip[0].xy / clip[0].w, b = clip[1].xy / clip[1].w, c = clip[2].xy / clip[2].w;
  // One pixel more, for rounding.
  return is_hidden(half_size * (1.0 + min(a, min(b, c))) - 1.0,
                   half_size * (1.0 + max(a, max(b, c))) + 1.0, half_size);
}

// Vertices are rounded to a grid of 1/256 of a pixel, or 1/16 at worst, which moves the edges. The
// triangle is therefore enlarged by this many pixels, so that the distances alone decide where alpha
// is 0. With a small sigma, alpha is about 1/2 close to an edge (docs/numerics.md, W16).
const float margin = 1.0 / 16.0;

#if AS_PUBLISHED
// Triangle Splatting draws neither windows whose corners are all within a pixel of the image of the
// centre, or one farther than 1600 pixels, nor those with an inradius below a pixel, nor those seen
// within a thousandth of edge-on. It divides by a negative w as by any other.
bool is_published(vec3 corners[3], vec4 clip[3]) {
  vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
  vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (!(abs(dot(normal, middle)) >= 1e-3 * length(normal) * length(middle))) return false;
  vec4 center = clip[0] + clip[1] + clip[2];
  vec2 image[3];
  float farthest = 0.0;
  for (int k = 0; k < 3; ++k) {
    // Relative to the centre.
    image[k] = half_size * (clip[k].xy / clip[k].w - center.xy / center.w);
    farthest = max(farthest, length(image[k]));
  }
  vec2 a = image[1] - image[0], b = image[2] - image[0];
  float inradius = abs(a.x * b.y - a.y * b.x) / (length(a) + length(b) + length(b - a));
  return farthest >= 1.0 && farthest <= 1600.0 && inradius >= 1.0;
}
#endif

void main() {
  uint splat = ordered_splat();
  int corner = splat_corner();
  vec4 texels[3];
  vec3 corners[3];
  vec4 clip[3];
  vec3 extent = vec3(0.0);
  for (int k = 0; k < 3; ++k) {
    texels[k] = kernel_texel(splat, k);
    corners[k] = (texels[k].xyz - eye_high) - eye_low;
    extent = max(extent, abs(corners[k]));
  }
  // Fourth powers of lengths would underflow below 1e-10 and overflow beyond 1e9 (docs/numerics.md,
  // E8). Homogeneous points keep their image in another unit; a power of 2 adds no rounding.
  float size = uintBitsToFloat(floatBitsToUint(max(extent.x, max(extent.y, extent.z))) & 0x7f800000u);
  for (int k = 0; k < 3; ++k) {
    corners[k] /= size;
    clip[k] = clip_from_camera * vec4(corners[k], 1.0 / size);
  }
  vec3 lengths;  // |N_k.xy|
  float total = 0.0;
  float determinant = 0.0, largest_w = 0.0;  // of the Q_k; of the corners, without sign
  for (int k = 0; k < 3; ++k) {
    int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    // The difference of the stored positions is more exact than that of the image points.
    vec4 edge = clip_from_camera * vec4((texels[j].xyz - texels[i].xyz) / size, 0.0);
    // Either end may stand for the edge's line; the nearer one has the smaller rounding.
    vec3 start = dot(corners[i], corners[i]) < dot(corners[j], corners[j]) ? clip[i].xyw : clip[j].xyw;
    vec2 normal = half_size.yx * vec2(start.y * edge.w - start.z * edge.y,
                                      start.z * edge.x - start.x * edge.w);
    lengths[k] = length(normal);
    total += clip[k].w * lengths[k];
    if (abs(clip[i].w) > largest_w) {
      largest_w = abs(clip[i].w);
      vec4 other = clip_from_camera * vec4((texels[k].xyz - texels[i].xyz) / size, 0.0);
      vec2 across = half_size * (other.xy * clip[i].w - clip[i].xy * other.w);
      determinant = abs(dot(normal, across)) / largest_w;
    }
  }
  color = texelFetch(colors, projected_position(splat * uint(COLORS_PER_SPLAT)), 0);
  sigma = texels[0].w;
#if MEASURES
  measure_vertex(cross((texels[1].xyz - texels[0].xyz) / size,
                       (texels[2].xyz - texels[0].xyz) / size),
                 corners[0]);
#endif
  // Behind the eye, or without area in the image.
  bool visible = color.a > 0.0 && total > 0.0 && min(lengths.x, min(lengths.y, lengths.z)) > 0.0;
#if AS_PUBLISHED
  visible = visible && is_published(corners, clip);
#endif
  visible = visible && !is_triangle_hidden(clip);

  // The lines N_k + margin |N_k.xy| z meet in sums of the corners with these weights, also where
  // corners are behind the eye. The limit keeps needles short. Where rho is below `min_rho`, alpha
  // is below MIN_ALPHA: the triangle is that much smaller.
  float longest = max(lengths.x, max(lengths.y, lengths.z));
  float min_rho = exp2(min(log2(MIN_ALPHA / color.a) / sigma, 0.0));
  float shift = min(margin / determinant, 1.0 / (largest_w * longest)) - min_rho / total;
  vec3 weights = -shift * clip[corner].w * lengths;
  weights[corner] += 1.0 + shift * total;
  gl_Position = visible ? weights.x * clip[0] + weights.y * clip[1] + weights.z * clip[2] : nowhere;
  distances = visible ? weights * total / lengths : vec3(0.0);
  if (visible)
    gl_Position =
        at_center_depth(gl_Position, size * (clip[0].w + clip[1].w + clip[2].w) / 3.0, splat);
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
  unit = size;
  weight = weights.x + weights.y + weights.z;
#endif
#if COLORS_PER_SPLAT == 3
  weighted_color = vec4(0.0);
  for (int k = 0; k < 3; ++k) {
    vec3 rgb = texelFetch(colors, projected_position(3u * splat + uint(k)), 0).rgb;
    weighted_color += weights[k] * max(clip[k].w, 0.0) * vec4(rgb, 1.0);
  }
#endif
}
