#include "examples/curve.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tureen::example {
namespace {
constexpr int steps_per_segment = 64;
}

Curve::Curve(std::vector<glm::dvec3> points) : points_(std::move(points)) {
  const glm::dvec3 before = 2.0 * points_[0] - points_[1];
  const glm::dvec3 after = 2.0 * points_.back() - points_[points_.size() - 2];
  points_.insert(points_.begin(), before);
  points_.push_back(after);
  const std::size_t steps = (points_.size() - 3) * steps_per_segment;
  arc_.push_back(0);
  for (std::size_t i = 1; i <= steps; ++i)
    arc_.push_back(arc_.back() + glm::distance(point(double(i) / steps_per_segment),
                                               point(double(i - 1) / steps_per_segment)));
}

glm::dvec3 Curve::point(double parameter) const {
  const int segments = static_cast<int>(points_.size()) - 3;
  const int i = std::clamp(static_cast<int>(parameter), 0, segments - 1);
  const double t = parameter - i;
  const glm::dvec3 &a = points_[i], &b = points_[i + 1], &c = points_[i + 2], &d = points_[i + 3];
  return 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                t * t * t * (3.0 * b - a - 3.0 * c + d));
}

glm::dvec3 Curve::at(double t) const {
  const double wanted = std::clamp(t, 0.0, 1.0) * length();
  const auto upper = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, wanted);
  const auto i = static_cast<std::size_t>(upper - arc_.begin());
  const double within = (wanted - arc_[i - 1]) / (arc_[i] - arc_[i - 1]);
  return point((double(i - 1) + within) / steps_per_segment);
}

glm::dvec3 Curve::tangent(double t) const {
  constexpr double h = 1e-4;  // far above rounding errors, far below the curves' radii
  return glm::normalize(at(std::min(t + h, 1.0)) - at(std::max(t - h, 0.0)));
}

}  // namespace tureen::example
