// EWA splatting of a Gaussian: its covariance in the image by the affine approximation of the
// projection at its centre.
uniform float pixel_area;      // in samples
uniform vec2 focal;            // in pixels
uniform vec2 principal_point;  // in pixels from the lower left corner of the image
uniform vec4 slope_range;      // the smallest x/depth and y/depth of the approximation, the largest
uniform float near;

// The centre in pixels from the lower left corner, the z of the view space, and the distance from
// the centre, in standard deviations, at which alpha falls below MIN_ALPHA; 0 if the splat is not
// drawn.
layout(location = 1) out vec4 place;
layout(location = 2) out vec4 axes;  // of one standard deviation, in pixels

float project(uint splat, out vec3 from_eye) {
  vec4 texel = kernel_texel(splat, 0);
  from_eye = (texel.xyz - eye_high) - eye_low;
  // min() below may hide a NaN (docs/numerics.md, B3). Mesa makes a < b of !(a >= b), and a >= 0 && b >= 0
  // into min(a, b) >= 0: both lose NaN.
  float sum = dot(kernel_texel(splat, 1).xyz, vec3(1.0));
  float opacity = sum >= 0.0 ? texel.w : 0.0;
  vec3 center = view_from_layer * from_eye;
  float depth = -center.z;
  place = vec4(0.0);
  axes = vec4(0.0);
  if (!(depth > near && is_center_drawn(depth))) return 0.0;

  // Beyond 1e18 pixels the squares below overflow.
  vec3 scales = min(kernel_texel(splat, 1).xyz, 1e18 * depth / max(focal.x, focal.y));
  mat3 rotation = view_from_layer * rotation_of(kernel_texel(splat, 2));
  // Rows of the Jacobian times the scaled axes: a 2 x 3 matrix M, with covariance M M^T.
  vec2 slope = clamp(center.xy / depth, slope_range.xy, slope_range.zw);
  vec3 x = (vec3(rotation[0].x, rotation[1].x, rotation[2].x) +
            slope.x * vec3(rotation[0].z, rotation[1].z, rotation[2].z)) * scales * (focal.x / depth);
  vec3 y = (vec3(rotation[0].y, rotation[1].y, rotation[2].y) +
            slope.y * vec3(rotation[0].z, rotation[1].z, rotation[2].z)) * scales * (focal.y / depth);
  // The fourth powers below overflow beyond 1e9 pixels, which centres near the eye's plane reach
  // (docs/numerics.md, E2): large Gaussians are measured in another unit.
  float unit = max(length(x), length(y));
  unit = unit > 1e7 ? unit : 1.0;
  x /= unit;
  y /= unit;
  float xx = dot(x, x), xy = dot(x, y), yy = dot(y, y);
  // The determinant as a cross product: xx yy - xy^2 cancels for needles (docs/numerics.md, E1).
  vec3 normal = cross(x, y);
  float determinant = dot(normal, normal);
#if DILATION
  float before = determinant, variance = DILATION_VARIANCE * pixel_area / unit / unit;
  determinant += variance * (xx + yy + variance);
  xx += variance;
  yy += variance;
#endif
#if KEEP_INTEGRAL
  opacity *= sqrt(before / determinant);
#endif
  float excess = 2.0 * log(opacity / MIN_ALPHA);
  if (!(excess > 0.0)) return 0.0;

  float half_difference = 0.5 * (xx - yy);
  float root = length(vec2(half_difference, xy));
  float larger = 0.5 * (xx + yy) + root;
  float smaller = determinant / larger;
  vec2 direction = half_difference > 0.0 ? vec2(half_difference + root, xy)
                                         : vec2(xy, root - half_difference);
  float direction_length = length(direction);
  direction = direction_length > 0.0 ? direction / direction_length : vec2(1.0, 0.0);
  axes = unit * vec4(sqrt(larger) * direction, sqrt(smaller) * vec2(-direction.y, direction.x));
  place = vec4(focal * (center.xy / depth) + principal_point, center.z, sqrt(excess));
  return opacity;
}
