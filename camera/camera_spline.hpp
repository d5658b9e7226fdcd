// Smooth curves through values and rotations at given times, for camera paths. All are cubic
// Hermite curves with C1 joints. The derivative at a joint depends on both neighbours.
//
// Derivatives are those of the parabola through a joint and its neighbours, for uneven times:
//   m = (h1 d0 + h0 d1) / (h0 + h1),  d = the mean speed before and after, h = the spans;
// at most three times the slower of d0 and d1 (F. N. Fritsch and R. E. Carlson, "Monotone piecewise
// cubic interpolation", SIAM J. Numer. Anal. 17, 1980). Constant stretches therefore stay constant,
// and monotone data give monotone curves.
//
// Rotations follow M.-J. Kim, M.-S. Kim and S. Y. Shin, "A general construction scheme for unit
// quaternion curves with simple high order derivatives", SIGGRAPH 1995: with the cumulative
// Bernstein polynomials B1..B3 of degree 3,
//   q(u) = q0 exp(B1(u) w1) exp(B2(u) w2) exp(B3(u) w3),
//   w1 = h a / 3,  w3 = h b / 3,  exp(w2) = exp(-w1) q0^-1 q1 exp(-w3),
// where a and b are the angular velocities at the ends in the turning frame. A uniform turn about
// one axis is reproduced exactly.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace tureen {

/// The rotation vector (axis times angle, at most half a turn) of a unit quaternion.
glm::dvec3 rotation_vector(const glm::dquat& rotation);
/// The inverse of rotation_vector, for vectors of any length.
glm::dquat rotation_of_vector(const glm::dvec3& vector);

/// The interval between a joint and the next.
template <class Difference>
struct Span {
  Difference change;   // a difference of values, or a rotation vector in the frame of the joint
  double seconds = 1;  // > 0
};

/// The derivative at a joint between two spans. If one span is missing (the end of the curve), use
/// end_derivative().
glm::dvec3 joint_derivative(const Span<glm::dvec3>& before, const Span<glm::dvec3>& after);
double joint_derivative(const Span<double>& before, const Span<double>& after);

/// The derivative at the end of a curve, for a second derivative of 0 there. `other` is the
/// derivative at the span's other end.
template <class Difference>
Difference end_derivative(const Span<Difference>& span, const Difference& other) {
  return (1.5 / span.seconds) * span.change - 0.5 * other;
}

/// A value with its derivative by time; a rotation with its angular velocity in its own frame.
template <class Value, class Derivative>
struct Joint {
  Value value;
  Derivative derivative;
};

/// The curve at `part`, from 0 at `a` to 1 at `b`; the joints are `seconds` apart.
template <class Value>
Value hermite(const Joint<Value, Value>& a, const Joint<Value, Value>& b, double seconds,
              double part) {
  const double u = part, v = 1 - u;
  // Written as the first value plus a difference, so that a curve between equal values is constant.
  return a.value + u * u * (3 - 2 * u) * (b.value - a.value) +
         seconds * u * v * (v * a.derivative - u * b.derivative);
}

glm::dquat hermite(const Joint<glm::dquat, glm::dvec3>& a, const Joint<glm::dquat, glm::dvec3>& b,
                   double seconds, double part);

}  // namespace tureen
