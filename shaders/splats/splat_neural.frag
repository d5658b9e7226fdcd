// Alpha of a neural density (arXiv 2510.08491): the integral of b2 + sum_k a_k cos(w_k . u + b_k)
// along the ray's chord through the ellipsoid. With the chord's half length h and its middle m, a
// neuron's integral is 2 h sinc(w_k . d h) cos(w_k . m + b_k). It divides by no small number
// (docs/numerics.md, N1).
#include "eye.glsl"
#include "splat_kernel_texels.glsl"
#include "view_direction.glsl"

uniform float near;

flat in uint splat;
flat in vec3 color;
#if MEASURES
uniform mat3 world_from_layer;
#endif

#include "splat_depth_behind.glsl"
#include "splat_blended.glsl"

// The phase in [-pi, pi], where GLSL specifies sin and cos. The constants sum to 2 pi; products of
// the first with integers up to 2^11 are exact (docs/numerics.md, N12).
float reduced(float phase) {
  float turns = floor(phase * 0.15915494309189535 + 0.5);
  return (phase - turns * 6.28125) - turns * 0.0019353071795864769;
}

float sinc(float x) {
  float xx = x * x;
  // The series is exact to 1e-9 there.
  if (xx < 0.01) return 1.0 - xx * (1.0 / 6.0) * (1.0 - xx * (1.0 / 20.0));
  return sin(reduced(x)) / x;
}

void main() {
  vec3 ray = ray_through(gl_FragCoord.xy);
  float ray_length = length(ray);
  vec3 direction = ray / ray_length;
  vec4 texel = kernel_texel(splat, 1);
  // Lengths below are in this unit.
  float unit = power_of_two_below(max(texel.x, max(texel.y, texel.z)));
  vec3 semi_axes = texel.xyz / unit;
  vec3 to_eye = -((kernel_texel(splat, 0).xyz - eye_high) - eye_low) / unit;
  float density = texel.w;  // b2
  mat3 local_from_layer = transpose(rotation_of(kernel_texel(splat, 2)));
  float largest = max(semi_axes.x, max(semi_axes.y, semi_axes.z));

  // The point of the ray nearest to the centre, corrected once; then, in the unit sphere's space,
  // the middle of the chord, corrected once. The distance of the eye does not enter its rounding.
  vec3 nearest = to_eye - dot(to_eye, direction) * direction;
  nearest -= dot(nearest, direction) * direction;
  float t = dot(nearest - to_eye, direction);
  vec3 unit_direction = (local_from_layer * direction) / semi_axes;
  vec3 unit_point = (local_from_layer * nearest) / semi_axes;
  float squared_speed = dot(unit_direction, unit_direction);
  float shift = -dot(unit_point, unit_direction) / squared_speed;
  vec3 middle = unit_point + shift * unit_direction;
  float correction = -dot(middle, unit_direction) / squared_speed;
  middle += correction * unit_direction;
  shift += correction;
  float discriminant = 1.0 - dot(middle, middle);
  if (!(discriminant > 0.0)) {
    blend_nothing();
    return;
  }
  float half_chord = sqrt(discriminant / squared_speed);

  // The part of the chord between the near plane and the soups.
  float middle_t = t + shift;
  float begin = max(middle_t - half_chord, near / unit * ray_length);
  float behind = depth_behind();
  float end = behind < infinity ? min(middle_t + half_chord, behind / unit * ray_length)
                                : middle_t + half_chord;
  if (!(end > begin)) {
    blend_nothing();
    return;
  }
  vec3 offset = nearest + shift * direction;
  if (begin > middle_t - half_chord || end < middle_t + half_chord) {
    float cut_middle = 0.5 * (begin + end);
    offset += (cut_middle - middle_t) * direction;
    half_chord = 0.5 * (end - begin);
  }

  vec3 u = offset / largest;
  float half_length = half_chord / largest;
  for (int k = 0; k < 8; ++k) {
    vec4 neuron = kernel_texel(splat, 3 + k);
    vec4 amplitudes = kernel_texel(splat, 11 + k / 4);
    density += amplitudes[k % 4] * sinc(dot(neuron.xyz, direction) * half_length) *
               cos(reduced(dot(neuron.xyz, u) + neuron.w));
  }
  float depth = 2.0 * half_length * density;
  // 1 - exp(-depth) without cancellation (docs/numerics.md, N8); the series is exact to 1e-9.
  float alpha = depth < 0.005 ? depth * (1.0 - 0.5 * depth * (1.0 - depth * (1.0 / 3.0)))
                              : 1.0 - exp(-depth);
#if OUTPUT == OUTPUT_COLOR
  blend(color, alpha);
#elif OUTPUT == OUTPUT_SAMPLE
  sample_splat(color, alpha, 0.5 * (begin + end) * unit / ray_length);
#else
  // The normal of the ellipsoid where the ray enters it.
  vec3 entry = middle - sqrt(discriminant / squared_speed) * unit_direction;
  vec3 normal = normalize((entry / semi_axes) * local_from_layer);
  measure(alpha, 0.5 * (begin + end) * unit / ray_length, world_from_layer * normal, 0.0, 0.0);
#endif
}
