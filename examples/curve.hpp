// A smooth curve through given points, walked at constant speed: profiles of porcelain, stems.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace tureen::example {

/// A uniform Catmull-Rom spline, whose end tangents are the end segments, parametrised by arc
/// length.
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

  std::vector<glm::dvec3> points_;  // with one more at either end
  std::vector<double> arc_;         // length up to equidistant parameters
};

}  // namespace tureen::example
