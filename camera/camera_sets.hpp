// Sets of views to measure with: evenly from above, and those that hurt. Plain maths beside
// camera/navigation.hpp, the same for the same scene on every machine.
#pragma once

#include <array>
#include <vector>

#include "camera/navigation.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// `count` cameras spread evenly over the upper half of a sphere around the box (the Fibonacci
/// lattice: equal steps of height, azimuth by the golden angle), all at the distance at which each
/// shows the whole box. The first are the lowest. Names are "hemisphere 0", ..
std::vector<Camera> hemisphere(const Subject& subject, int count, const Lens& lens);

/// How much a view would draw, roughly: in units of the whole picture, the area of all triangles
/// that lie before the eye, cut to the picture and counted one over the other. 1 is a picture
/// covered once. Small triangles count where their centre falls; large ones by the cells of a grid
/// of 64 x 36 that their centres cover. `origin` is the soup's (Scene::origin).
double estimated_overdraw(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// How the faces are turned to the eye: the mean of |cos| between normal and line of sight over the
/// faces, weighted by area. 0: all edge-on.
double facing(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera);

/// What the four adversarial_views() are called, in their order.
inline constexpr std::array adversarial_names = {"inside", "far", "grazing", "most overdraw"};

/// Four views that a renderer may fear:
///   "inside"         the eye in the middle of the geometry (the centre of mass of the triangles),
///                    looking along that of eight level directions which draws most
///   "far"            the whole box at a twentieth of its framed size: triangles below a pixel
///   "grazing"        of 64 views around the box, the one with the least facing()
///   "most overdraw"  of 24 directions at the framing distance, half and a quarter of it, the view
///                    with the largest estimated_overdraw()
/// Of scenes with more than 200,000 faces every n-th is looked at. Asserts a soup without defect();
/// one without triangles gives four framed views.
std::vector<Camera> adversarial_views(const TriangleSoup& soup, glm::dvec3 origin,
                                      const Subject& subject, const Lens& lens);

}  // namespace tureen
