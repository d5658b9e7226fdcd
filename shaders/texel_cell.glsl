// A texel's colour in a shade from 0 to 2, so that neighbours of equal colour differ. Each step
// mixes 8 % of white into dark colours, of black into bright ones.
vec3 cell_color(vec3 color, int shade) {
  float luma = dot(color, vec3(0.299, 0.587, 0.114));
  return mix(color, vec3(luma > 0.5 ? 0.0 : 1.0), 0.08 * float(shade));
}
