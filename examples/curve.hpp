// A smooth curve through given points with constant speed, for profiles of porcelain and for stems.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace tureen::example {

/// A uniform Catmull-Rom spline, parametrised by arc length. The end tangents are those of the end
/// segments.
class Curve {
 public:
  /// At least two points.
  explicit Curve(std::vector<glm::dvec3> points);

  /// t in [0, 1], as a fraction of length(); clamped.
  glm::dvec3 at(double t) const;
  /// Unit length.
  glm::dvec3 tangent(double t) const;
  double length() const { return arc_.back(); }

 private:
  glm::dvec3 point(double parameter) const;  // [0, number of segments]

  std::vector<glm::dvec3> points_;  // with an additional point at each end
  std::vector<double> arc_;         // lengths up to equidistant parameters
};

}  // namespace tureen::example
