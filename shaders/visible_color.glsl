// The colour of a fragment from the visibility pass: the shading function of shading.frag and
// shading.comp.
#include "appearance.glsl"
#include "stored_fragment.glsl"
#include "view_direction.glsl"

uniform usampler2D visible;  // written by visibility.frag

// `window` is the middle of the pixel, y up.
vec4 visible_color(uvec2 fragment, vec2 window) {
  return vec4(fragment_color(stored_slot(fragment), stored_barycentrics(fragment), direction_to_eye(window)), 1.0);
}
