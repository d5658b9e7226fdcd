// What the plain baselines for splats share in the vertex shader: the splat of an instance, its
// quad's vertex, and its colour, evaluated at each of the quad's four vertices.
#include "eye.glsl"
#include "harmonics_color.glsl"

layout(location = 0) in uint splat;  // of the instance

uniform sampler2DArray kernel;  // three texels per splat
uniform mat3 view_from_layer;   // rotation, perhaps a mirror
uniform vec2 focal;             // in pixels
uniform vec2 principal_point;   // in pixels from the lower left corner of the image
uniform vec2 half_size;         // of the image, in pixels
uniform float near;
uniform float min_center_depth;  // SplatProfile::min_center_depth

// A vertex of a quad that covers no pixel.
const vec4 nowhere = vec4(0.0, 0.0, 2.0, 1.0);

vec4 stored(int i) {
  return texelFetch(kernel, texel_position(3u * splat + uint(i)), 0);
}

// A corner of the square from (0, 0) to (1, 1), in the order of a triangle strip.
vec2 quad_corner() { return vec2(gl_VertexID & 1, gl_VertexID >> 1); }

vec4 at_pixel(vec2 pixel) { return vec4(pixel / half_size - 1.0, 0.0, 1.0); }

vec3 color_towards(vec3 from_eye) {
  return max(harmonics_color(splat, normalize(from_eye)), 0.0);
}
