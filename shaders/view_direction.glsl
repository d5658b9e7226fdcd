// The direction from a pixel's surface to the eye, from the camera's axes: no inverse matrix, no
// dependence on the depth range or on where the camera stands (docs/numerics.md, V1).
uniform vec3 ray_at_corner;   // world direction, eye to surface, through window position (0, 0)
uniform vec3 ray_per_column;  // how it changes a pixel to the right
uniform vec3 ray_per_row;     // and a pixel up

// Through a window position, with a depth of 1 along the viewing axis.
vec3 ray_through(vec2 window) {
  return ray_at_corner + window.x * ray_per_column + window.y * ray_per_row;
}

vec3 direction_to_eye(vec2 window) { return -normalize(ray_through(window)); }
