// Texels that splat_project.frag writes for each splat, in rows of PROJECTED_COLUMNS.
ivec2 projected_position(uint splat) {
  return ivec2(int(splat % uint(PROJECTED_COLUMNS)), int(splat / uint(PROJECTED_COLUMNS)));
}
