// Windows are projected per vertex (splat_windows.vert).
float project(uint splat, out vec3 from_eye) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 3; ++i) sum += (kernel_texel(splat, i).xyz - eye_high) - eye_low;
  from_eye = sum / 3.0;
  return is_center_drawn(-(view_from_layer * from_eye).z) ? kernel_texel(splat, 1).w : 0.0;
}
