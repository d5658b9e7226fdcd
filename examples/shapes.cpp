#include "examples/shapes.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tureen::example {
namespace {

using std::numbers::pi;

glm::dvec3 around(double u, double radius, double y) {
  return {radius * std::sin(2 * pi * u), y, radius * std::cos(2 * pi * u)};
}

}  // namespace

Shape turned(Curve profile, Placement placement) {
  return [profile = std::move(profile), placement](glm::dvec2 uv) {
    const glm::dvec3 p = profile.at(uv.y);
    return placement.center + placement.frame * around(uv.x, p.x, p.y);
  };
}

Shape tube(Curve center_line, std::function<double(double)> radius) {
  return [line = std::move(center_line), radius = std::move(radius)](glm::dvec2 uv) {
    const glm::dvec3 t = line.tangent(uv.y);
    // No curve of the still life is parallel to this axis.
    const glm::dvec3 n = glm::normalize(glm::cross(t, glm::dvec3(0.12, 0.31, 0.943)));
    const glm::dvec3 b = glm::cross(t, n);
    const double a = 2 * pi * uv.x;
    return line.at(uv.y) + radius(uv.y) * (std::cos(a) * n + std::sin(a) * b);
  };
}

Shape strip(Curve middle, double width, double fold) {
  return [middle = std::move(middle), width, fold](glm::dvec2 uv) {
    const glm::dvec3 t = middle.tangent(uv.y);
    const glm::dvec3 side = glm::normalize(glm::cross(t, glm::dvec3(0.01, 1, 0.02)));
    const double across = (uv.x - 0.5) * width;
    return middle.at(uv.y) + across * side + fold * std::abs(across) * glm::cross(side, t);
  };
}

Shape disc(double radius, Placement placement) {
  return [radius, placement](glm::dvec2 uv) {
    const double a = 2 * uv.y - 1, b = 2 * uv.x - 1;
    double r = 0, angle = 0;
    if (std::abs(a) > std::abs(b)) {
      r = a;
      angle = pi / 4 * b / a;
    } else if (b != 0) {
      r = b;
      angle = pi / 2 - pi / 4 * a / b;
    }
    return placement.center +
           placement.frame * (radius * glm::dvec3(r * std::cos(angle), 0, r * std::sin(angle)));
  };
}

Shape ring(double inner, double outer, Placement placement) {
  return [inner, outer, placement](glm::dvec2 uv) {
    // u has the opposite direction of turned(), so that the outside is up.
    return placement.center + placement.frame * around(-uv.x, inner + (outer - inner) * uv.y, 0);
  };
}

glm::dmat3 frame_along(glm::dvec3 axis) {
  const glm::dvec3 y = glm::normalize(axis);
  const glm::dvec3 helper = std::abs(y.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, y));
  return {x, y, glm::cross(x, y)};
}

}  // namespace tureen::example
