// Windows are projected per vertex (splat_windows.vert). This file only gives the directions of their
// colours. With COLORS_PER_SPLAT 3, a texel belongs to a corner.
vec3 corner_from_eye(uint splat, int corner) {
  return (kernel_texel(splat, corner).xyz - eye_high) - eye_low;
}

float project(uint texel, out vec3 from_eye) {
  uint splat = texel / uint(COLORS_PER_SPLAT);
  vec3 center = vec3(0.0);
  for (int i = 0; i < 3; ++i) center += corner_from_eye(splat, i);
  center /= 3.0;
#if COLORS_PER_SPLAT == 3
  from_eye = corner_from_eye(splat, int(texel % 3u));
#else
  from_eye = center;
#endif
  return is_center_drawn(-(view_from_layer * center).z) ? kernel_texel(splat, 1).w : 0.0;
}
