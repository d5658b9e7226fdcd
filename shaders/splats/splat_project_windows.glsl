// Windows are projected per vertex (splat_windows.vert); here only their colours have a direction.
#if COLORS_PER_SPLAT == 3
float project(uint corner, out vec3 from_eye) {
  uint splat = corner / 3u;
  from_eye = (kernel_texel(splat, int(corner % 3u)).xyz - eye_high) - eye_low;
  return kernel_texel(splat, 1).w;
}
#else
float project(uint splat, out vec3 from_eye) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 3; ++i) sum += (kernel_texel(splat, i).xyz - eye_high) - eye_low;
  from_eye = sum / 3.0;
  return is_center_drawn(-(view_from_layer * from_eye).z) ? kernel_texel(splat, 1).w : 0.0;
}
#endif
