// Neural densities are projected per vertex (splat_neural.vert).
float project(uint splat, out vec3 from_eye) {
  from_eye = (kernel_texel(splat, 0).xyz - eye_high) - eye_low;
  return is_center_drawn(-(view_from_layer * from_eye).z) ? 1.0 : 0.0;
}
