// Sets of views for measurements: evenly distributed ones and worst cases. Pure mathematics as in
// camera/navigation.hpp; the same scene gives the same views on every machine.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "camera/navigation.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// The name of a set of views on the command line: "hemisphere:8".
struct CameraSetName {
  std::string kind;
  int count = 8;  // views, 1..1000

  std::string text() const { return kind + ":" + std::to_string(count); }
};

/// Reads "KIND" or "KIND:COUNT". Returns nullopt if KIND is not in `kinds`. Throws UsageError if
/// COUNT is not a number in its range.
std::optional<CameraSetName> parse_camera_set(std::string_view text,
                                              std::initializer_list<std::string_view> kinds);

/// `count` cameras spread evenly over the upper half of a sphere around the box (the Fibonacci
/// lattice: equal steps of height, azimuth by the golden angle). All have the same distance,
/// the smallest at which each camera shows the whole box. The first are the lowest. Names are
/// "hemisphere 0", ..
std::vector<Camera> hemisphere(const Subject& subject, int count, const Lens& lens);

/// Approximate overdraw of a view: the sum of the projected areas of all triangles in the image, in
/// units of the image area. 1 means that the image is covered once. The image is divided into 64 x
/// 36 cells. A triangle smaller than a cell adds its area if its centre is in the image; a larger
/// one adds the area of the cells whose centres it covers. A triangle that reaches behind the eye
/// adds 0. `origin` is the soup's origin in world coordinates.
double estimated_overdraw(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// Mean orientation of the faces towards the eye: |cos| between normal and line of sight, weighted
/// by area. 0: all edge-on.
double facing(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// Names of the four adversarial_views(), in their order.

/// Four worst-case views for a renderer:
///   "inside"         the eye at the centre of mass of the triangles; of eight horizontal
///                    directions, the one with the largest overdraw
///   "far"            the whole box at a twentieth of its framed size: triangles below a pixel
///   "grazing"        of 64 views around the box, the view with the smallest facing()
///   "most overdraw"  of 72 views, the one with the largest estimated_overdraw(): 24 directions,
///                    each at 1, 1/2 and 1/4 of the framing distance
/// Scenes with more than 200,000 faces are sampled at every n-th face. The soup must have no
/// defect(). A soup without triangles also gives four views; "inside" is then at the centre of the
/// box.
std::vector<Camera> adversarial_views(const TriangleSoup& soup, glm::dvec3 origin,
                                      const Subject& subject, const Lens& lens);

}  // namespace tureen
