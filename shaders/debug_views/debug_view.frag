// Colours the covered pixels of the visibility pass by a debug view. SHOWN is one of the SHOW_..
// constants, DebugView in C++.
#include "appearance.glsl"
#include "face_corners.glsl"
#include "heat_ramp.glsl"
#include "debug_view_appearance.glsl"
#include "stored_fragment.glsl"
#include "triangle_color.glsl"
#include "view_direction.glsl"

uniform usampler2D visible;           // written by visibility.frag
uniform usampler2DArray soup_faces;   // the soup's index of a slot
uniform vec4 background;
uniform vec2 depth_scale;             // ln(near), 1 / ln(far / near)
uniform int first_feature, features_shown;
uniform mat3 world_from_layer;        // rotation or reflection
uniform int layer;

layout(location = 0) out vec4 color;

#if SHOWN == SHOW_SURFACE
uniform float world_scale;  // world units a layer unit

// The normal towards the eye in world axes, and the depth in world units.
vec4 surface(uint face) {
  vec3 ray = ray_through(gl_FragCoord.xy);
  vec3 normal = face_normal(face);
  vec3 towards_eye = dot(normal, ray) > 0.0 ? -normal : normal;
  return vec4(world_from_layer * towards_eye, world_scale * depth_on(face, normal, ray));
}
#else
float feature(vec4 first, vec4 second, int index) {
  return index < 4 ? first[index] : second[index - 4];
}

vec3 shown(uint face, vec2 b) {
#if SHOWN == SHOW_DEPTH || SHOWN == SHOW_MEDIAN_DEPTH
  vec3 ray = ray_through(gl_FragCoord.xy);
  float z = depth_on(face, face_normal(face), ray);
  return depth_color(z, depth_scale);
#elif SHOWN == SHOW_NORMALS
  vec3 normal = face_normal(face);
  if (dot(normal, ray_through(gl_FragCoord.xy)) > 0.0) normal = -normal;
  return 0.5 * (world_from_layer * normal) + 0.5;
#elif SHOWN == SHOW_TRIANGLE_ID
  return triangle_color(texelFetch(soup_faces, texel_position(face), 0).r, uint(layer));
#elif SHOWN == SHOW_TEXELS
  return debug_view_texel(face, b);
#elif SHOWN == SHOW_ALPHA
  float alpha = debug_view_alpha(face, b);
  float threshold = debug_view_threshold(face);
  if (alpha >= threshold) return vec3(alpha);
  // cut_out_color() of runtime/debug_views/debug_view.cpp.
  return mix(vec3(0.22, 0.08, 0.36), vec3(0.78, 0.42, 0.70), max(alpha, 0.0) / threshold);
#elif SHOWN == SHOW_MLP_WEIGHT || SHOWN == SHOW_FEATURES
  vec4 first, second;
  debug_view_features(face, b, first, second);
  if (features_shown == 1) return vec3(feature(first, second, first_feature));
  return vec3(feature(first, second, first_feature), feature(first, second, first_feature + 1),
              features_shown > 2 ? feature(first, second, first_feature + 2) : 0.0);
#else
  return fragment_color(face, b, -normalize(ray_through(gl_FragCoord.xy))) * COLOR_SCALE;
#endif
}

#endif

void main() {
  uvec2 fragment = texelFetch(visible, ivec2(gl_FragCoord.xy), 0).xy;
#if SHOWN == SHOW_SURFACE
  color = fragment.x == NO_FACE ? vec4(0.0) : surface(stored_slot(fragment));
#else
  color = fragment.x == NO_FACE ? background
                                : vec4(shown(stored_slot(fragment), stored_barycentrics(fragment)), 1.0);
#endif
}
