#include "camera/camera_spline.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tureen {

namespace {

double size_of(double value) { return std::abs(value); }
double size_of(const glm::dvec3& value) { return glm::length(value); }

template <class Difference>
Difference derivative_between(const Span<Difference>& before, const Span<Difference>& after) {
  const Difference slope0 = (1 / before.seconds) * before.change;
  const Difference slope1 = (1 / after.seconds) * after.change;
  // With a quotient of spans instead of their product, long spans do not overflow and short ones do
  // not underflow.
  const double share = after.seconds / (before.seconds + after.seconds);
  const Difference parabola = share * slope0 + (1 - share) * slope1;
  const double most = 3 * std::min(size_of(slope0), size_of(slope1)), size = size_of(parabola);
  return size > most ? (most / size) * parabola : parabola;
}

}  // namespace

glm::dvec3 joint_derivative(const Span<glm::dvec3>& before, const Span<glm::dvec3>& after) {
  return derivative_between(before, after);
}

double joint_derivative(const Span<double>& before, const Span<double>& after) {
  return derivative_between(before, after);
}

glm::dvec3 rotation_vector(const glm::dquat& rotation) {
  // q and -q are the same rotation; the one with w >= 0 turns by at most half a turn.
  const double sign = rotation.w < 0 ? -1.0 : 1.0;
  const glm::dvec3 v(sign * rotation.x, sign * rotation.y, sign * rotation.z);
  const double sine = glm::length(v);
  // The angle is 2 asin(sine). Below 1e-8 it equals 2 sine to all digits.
  return (sine > 1e-8 ? 2 * std::atan2(sine, sign * rotation.w) / sine : 2.0) * v;
}

glm::dquat rotation_of_vector(const glm::dvec3& vector) {
  const double angle = glm::length(vector);
  // Below 1e-8 the next term of the series, angle^2 / 48, is below the last digit.
  const glm::dvec3 v = (angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5) * vector;
  return glm::normalize(glm::dquat(std::cos(0.5 * angle), v.x, v.y, v.z));
}

glm::dquat hermite(const Joint<glm::dquat, glm::dvec3>& a, const Joint<glm::dquat, glm::dvec3>& b,
                   double seconds, double part) {
  const glm::dvec3 w1 = seconds / 3 * a.derivative, w3 = seconds / 3 * b.derivative;
  const glm::dvec3 w2 = rotation_vector(rotation_of_vector(-w1) * glm::conjugate(a.value) *
                                        b.value * rotation_of_vector(-w3));
  const double u = part, v = 1 - u;
  return glm::normalize(a.value * rotation_of_vector((1 - v * v * v) * w1) *
                        rotation_of_vector(u * u * (3 - 2 * u) * w2) *
                        rotation_of_vector(u * u * u * w3));
}

}  // namespace tureen
