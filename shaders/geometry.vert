// Unshared triangles: gl_VertexID / 3 is the face. Works in camera-relative coordinates, so that a
// scene far from the origin loses no precision (docs/numerics.md, G3).
layout(location = 0) in vec3 position;  // relative to the soup's origin

uniform vec3 eye_high, eye_low;  // their sum is the eye; position - eye_high is exact when close
uniform mat4 clip_from_camera;   // rotation and projection, no translation

flat out uint face;
out vec2 barycentrics;

invariant gl_Position;

void main() {
  uint vertex = uint(gl_VertexID);
  face = vertex / 3u;
  uint corner = vertex - 3u * face;
  barycentrics = vec2(corner == 0u ? 1.0 : 0.0, corner == 1u ? 1.0 : 0.0);
  gl_Position = clip_from_camera * vec4((position - eye_high) - eye_low, 1.0);
}
