// A texel's colour so that it differs from its neighbours' where all have the same: two or three
// shades, away from what it is, dark ones brighter and bright ones darker.
vec3 cell_color(vec3 color, int shade) {
  float luma = dot(color, vec3(0.299, 0.587, 0.114));
  return mix(color, vec3(luma > 0.5 ? 0.0 : 1.0), 0.08 * float(shade));
}
