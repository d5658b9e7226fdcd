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
/// lattice: equal steps of height, azimuth by the golden angle). All have the distance at which
/// each shows the whole box. The first are the lowest. Names are "hemisphere 0", ..
std::vector<Camera> hemisphere(const Subject& subject, int count, const Lens& lens);

/// Approximate overdraw of a view: the sum of the projected areas of all triangles in front of the
/// eye, clipped to the image, in units of the image area. 1 means that the image is covered once.
/// Small triangles count at their centre; large ones by the covered centres of a grid of 64 x 36
/// cells. `origin` is the soup's origin in world coordinates.
double estimated_overdraw(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// Mean orientation of the faces towards the eye: |cos| between normal and line of sight, weighted
/// by area. 0: all edge-on.
double facing(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// Names of the four adversarial_views(), in their order.
inline constexpr std::array adversarial_names = {"inside", "far", "grazing", "most overdraw"};

/// Four worst-case views for a renderer:
///   "inside"         the eye at the centre of mass of the triangles, looking in the direction with
///                    the largest overdraw, of eight horizontal ones
///   "far"            the whole box at a twentieth of its framed size: triangles below a pixel
///   "grazing"        of 64 views around the box, the view with the smallest facing()
///   "most overdraw"  of 24 directions at the framing distance, half and a quarter of it, the view
///                    with the largest estimated_overdraw()
/// Scenes with more than 200,000 faces are sampled at every n-th face. Asserts a soup without
/// defect(); a soup without triangles gives four framed views.
std::vector<Camera> adversarial_views(const TriangleSoup& soup, glm::dvec3 origin,
                                      const Subject& subject, const Lens& lens);

}  // namespace tureen
