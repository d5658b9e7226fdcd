// The direction from a pixel's surface to the eye, from the camera's axes: no inverse matrix, no
// dependence on the depth range or on the camera's position (docs/numerics.md, V1).
uniform vec3 ray_at_corner;   // in layer coordinates, eye to surface, through window position (0, 0)
uniform vec3 ray_per_column;  // its change a pixel to the right
uniform vec3 ray_per_row;     // its change a pixel up

// The ray through a window position, with a depth of 1 along the viewing axis.
vec3 ray_through(vec2 window) {
  return ray_at_corner + window.x * ray_per_column + window.y * ray_per_row;
}

vec3 direction_to_eye(vec2 window) { return -normalize(ray_through(window)); }
