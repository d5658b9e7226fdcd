// The plain baseline for triangle windows: a quad over the box of the triangle in the image. Windows
// with a corner behind the near plane are not drawn.
#include "baseline_splats_quad.glsl"

flat out vec3 edges[3];  // distance from an edge at a pixel, positive inside: dot(edge, (pixel, 1))
flat out float inradius, sigma;
flat out vec4 color;

void main() {
  gl_Position = nowhere;
  vec3 center = vec3(0.0);
  vec2 image[3];
  bool in_front = true;
  for (int k = 0; k < 3; ++k) {
    vec3 from_eye = (stored(k).xyz - eye_high) - eye_low;
    center += from_eye / 3.0;
    vec3 view = view_from_layer * from_eye;
    in_front = in_front && -view.z > near;
    image[k] = focal * view.xy / -view.z + principal_point;
  }
  float center_depth = -(view_from_layer * center).z;
  if (!in_front || (min_center_depth > 0.0 && !(center_depth > min_center_depth))) return;
  vec2 a = image[1] - image[0], b = image[2] - image[0];
  float area = a.x * b.y - a.y * b.x;  // twice, with sign
  inradius = abs(area) / (length(a) + length(b) + length(b - a));
  if (!(inradius > 0.0)) return;
  for (int k = 0; k < 3; ++k) {
    vec2 from = image[k], along = normalize(image[k == 2 ? 0 : k + 1] - from);
    vec2 inwards = sign(area) * vec2(-along.y, along.x);
    edges[k] = vec3(inwards, -dot(inwards, from));
  }
  sigma = stored(0).w;
  color = vec4(color_towards(center), stored(1).w);
  vec2 low = min(image[0], min(image[1], image[2])), high = max(image[0], max(image[1], image[2]));
  gl_Position = at_pixel(mix(low, high, quad_corner()));
}
