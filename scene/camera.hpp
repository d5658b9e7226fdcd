// A pinhole camera in pixels, in the OpenGL convention: in view space x points right, y up, and the
// camera looks along -z. Readers convert to this convention.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace tureen {

/// Focal lengths and principal point are in pixels. (cx, cy) is measured from the top left corner
/// of the image, to the right and down. If the viewing axis meets the centre of the image, cx is
/// width / 2 and cy is height / 2. Pixel centres lie at (column + 0.5, row + 0.5).
struct Camera {
  std::string name;
  int width = 0;
  int height = 0;
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;
  /// Rigid: a rotation and a translation. World coordinates are absolute; Layer::world_from_layer
  /// maps the positions of a soup to them.
  glm::dmat4 view_from_world{1.0};

  bool operator==(const Camera&) const = default;

  /// The camera's centre in world coordinates.
  glm::dvec3 eye() const;

  /// Columns are the camera's right, up and backward axes in world coordinates.
  glm::dmat3 world_from_view_rotation() const;
};

/// A camera at `eye` that looks at `target`. `fov_y` is the full vertical angle in radians; the
/// principal point is the image centre. If `up` is parallel to the line of sight, another axis
/// replaces it.
Camera look_at(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up, double fov_y, int width,
               int height);

/// The same view at another size. The vertical field of view is kept and square pixels stay square;
/// a wider image shows more at the sides.
Camera resized(const Camera& camera, int width, int height);

/// The same image, edge to edge, on another pixel grid. Each axis scales focal length and principal
/// point by its own factor, so rays through image points are unchanged. Pixels stay square only if
/// both sizes have the same aspect ratio.
Camera resampled(const Camera& camera, int width, int height);

/// Whether `point`, in world coordinates, lies in front of the camera and inside its image, edges
/// included.
bool in_image(const Camera& camera, glm::dvec3 point);

/// Clip from view. Maps the depth range [near, far] to NDC z in [-1, 1] (OpenGL's default). The y
/// axis points up, so row 0 of a read-back image is the bottom row.
glm::dmat4 clip_from_view(const Camera& camera, double near, double far);

/// Clip from view with reversed depth and an infinite far plane: NDC z = 1 at `near`, 0 at
/// infinity. Needs glClipControl(.., GL_ZERO_TO_ONE).
glm::dmat4 clip_from_view_reversed(const Camera& camera, double near);

}  // namespace tureen
