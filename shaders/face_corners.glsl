// The three corners of a face relative to the eye, and from them a pixel's normal, depth and
// distance to the edges.
#include "eye.glsl"
#include "texel_store.glsl"

uniform sampler2DArray corners;  // three texels a face, relative to the soup's origin
uniform vec3 view_axis;          // in layer coordinates, of unit length
// Window x and y (y up) of a point at c from the eye, times its depth: their dot products with c.
uniform vec3 window_x, window_y;

mat3 corners_from_eye(uint face) {
  mat3 result;
  for (int k = 0; k < 3; ++k) {
    vec3 position = texelFetch(corners, texel_position(3u * face + uint(k)), 0).xyz;
    result[k] = (position - eye_high) - eye_low;
  }
  return result;
}

float largest_component(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// The unit vector orthogonal to both edges. A needle's edges may have a cross product of 0 in
// floats; any direction is then better than NaN.
vec3 unit_normal(vec3 u, vec3 v) {
  vec3 across = cross(u, v);
  return dot(across, across) > 0.0 ? normalize(across) : vec3(0.0, 0.0, 1.0);
}

// The unit normal of a face of any size: the edges are scaled before the product. It uses the
// stored corners, because their differences have only one rounding.
vec3 face_normal(uint face) {
  vec3 a = texelFetch(corners, texel_position(3u * face), 0).xyz;
  vec3 u = texelFetch(corners, texel_position(3u * face + 1u), 0).xyz - a;
  vec3 v = texelFetch(corners, texel_position(3u * face + 2u), 0).xyz - a;
  return unit_normal(u / largest_component(u), v / largest_component(v));
}

// The depth at which the ray, of depth 1 along the viewing axis, meets the face's plane. It is
// clamped to the corners' depths, because an edge-on plane is imprecise.
float depth_on(uint face, vec3 normal, vec3 ray) {
  mat3 from_eye = corners_from_eye(face);
  vec3 depths = view_axis * from_eye;
  float low = min(depths.x, min(depths.y, depths.z));
  float high = max(depths.x, max(depths.y, depths.z));
  return clamp(dot(normal, from_eye[0]) / dot(normal, ray), low, high);
}

// Distance to the nearest edge of the face, in pixels of the image. In homogeneous coordinates
// around the pixel's centre, the line through two corners is their cross product, even if one is
// behind the eye.
float pixels_to_edge(uint face, vec2 pixel) {
  mat3 from_eye = corners_from_eye(face);
  vec3 w = view_axis * from_eye;
  vec3 x = window_x * from_eye - pixel.x * w;
  vec3 y = window_y * from_eye - pixel.y * w;
  float nearest = 1e30;
  for (int i = 0; i < 3; ++i) {
    int j = i == 2 ? 0 : i + 1;
    vec3 line = cross(vec3(x[i], y[i], w[i]), vec3(x[j], y[j], w[j]));
    nearest = min(nearest, abs(line.z) / length(line.xy));
  }
  return nearest;
}
