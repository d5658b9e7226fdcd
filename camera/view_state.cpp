#include "camera/view_state.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "camera/angles.hpp"

namespace tureen {

namespace {

/// The axes that the angles refer to; right-handed in this order.
struct Horizon {
  glm::dvec3 front, side, up;
  explicit Horizon(const glm::dvec3& axis)
      : front(direction_of(axis, {})), side(glm::cross(axis, front)), up(axis) {}
};

/// Columns: right, above and backward, without roll.
glm::dmat3 level_rotation(const Horizon& horizon, const Bearing& bearing) {
  const double c = std::cos(bearing.azimuth), s = std::sin(bearing.azimuth);
  const glm::dvec3 level = c * horizon.front + s * horizon.side;
  const glm::dvec3 right = c * horizon.side - s * horizon.front;
  const double ce = std::cos(bearing.elevation), se = std::sin(bearing.elevation);
  return {right, ce * horizon.up - se * level, ce * level + se * horizon.up};
}

double mixed(double from, double to, double part) { return from + (to - from) * part; }

double mixed_logarithm(double from, double to, double part) {
  return from == to ? to : from * std::pow(to / from, part);
}

}  // namespace

double ViewLens::fov_y() const { return 2 * std::atan(0.5 / focal); }

ViewLens lens_of_angle(double fov_y) { return {.focal = 0.5 / std::tan(0.5 * fov_y)}; }

ViewLens lens_of(const Camera& camera) {
  return {.focal = camera.fy / camera.height,
          .aspect = camera.fx / camera.fy,
          .offset = {(camera.cx - 0.5 * camera.width) / camera.height,
                     (camera.cy - 0.5 * camera.height) / camera.height}};
}

Camera camera_of(const ViewLens& lens, const glm::dmat3& axes, const glm::dvec3& eye, int width,
                 int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fy = lens.focal * height;
  camera.fx = camera.fy * lens.aspect;
  camera.cx = 0.5 * width + lens.offset.x * height;
  camera.cy = 0.5 * height + lens.offset.y * height;
  const glm::dmat3 rotation = glm::transpose(axes);
  camera.view_from_world = glm::dmat4(rotation);
  camera.view_from_world[3] = glm::dvec4(-(rotation * eye), 1.0);
  return camera;
}

glm::dmat3 rotation_of(const ViewState& state) {
  const glm::dmat3 level = level_rotation(Horizon(state.up), state.bearing);
  const double c = std::cos(state.roll), s = std::sin(state.roll);
  return {c * level[0] + s * level[1], c * level[1] - s * level[0], level[2]};
}

glm::dvec3 eye_of(const ViewState& state) {
  return state.target + state.distance * rotation_of(state)[2];
}

Camera camera_of(const ViewState& state, int width, int height) {
  return camera_of(state.lens, rotation_of(state), eye_of(state), width, height);
}

ViewState state_of(const Camera& camera, const glm::dvec3& up, double distance) {
  const Horizon horizon(up);
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 backward = glm::normalize(axes[2]);
  ViewState state{.up = up, .distance = distance};
  const double height = glm::dot(backward, up);
  const glm::dvec3 level = backward - height * up;
  // Near the poles, asin would lose half of the digits.
  state.bearing.elevation = std::atan2(height, glm::length(level));
  // In a view straight down, the top of the image points away from the eye of azimuth 0; in a view
  // straight up, towards it. At a level part of 1e-9, seven digits of the azimuth are left, just
  // enough for an image. The error of recorded axes may have the same size.
  const bool at_pole = glm::length(level) < 1e-9;
  const glm::dvec3 toward = at_pole ? axes[1] * (height > 0 ? -1.0 : 1.0) : level;
  state.bearing.azimuth =
      std::atan2(glm::dot(toward, horizon.side), glm::dot(toward, horizon.front));
  if (!at_pole) {
    const glm::dmat3 without_roll = level_rotation(horizon, state.bearing);
    state.roll = std::atan2(glm::dot(axes[0], without_roll[1]), glm::dot(axes[0], without_roll[0]));
  }
  state.lens = lens_of(camera);
  place_eye(state, camera.eye());
  return state;
}

ViewState with_up(const ViewState& state, const glm::dvec3& up) {
  ViewState result = state_of(camera_of(state, 1, 1), up, state.distance);
  result.target = state.target;
  result.lens = state.lens;
  return result;
}

void place_eye(ViewState& state, const glm::dvec3& eye) {
  state.target = eye - state.distance * rotation_of(state)[2];
}

void take_short_way(ViewState& state, const ViewState& reference) {
  const auto near = [](double angle, double other) {
    return other + std::remainder(angle - other, full_turn);
  };
  state.bearing.azimuth = near(state.bearing.azimuth, reference.bearing.azimuth);
  state.roll = near(state.roll, reference.roll);
}

ViewState between(const ViewState& from, const ViewState& to, double part, GlideAbout about) {
  if (part >= 1) return to;
  ViewState state = to;
  state.distance = mixed_logarithm(from.distance, to.distance, part);
  state.bearing = {mixed(from.bearing.azimuth, to.bearing.azimuth, part),
                   mixed(from.bearing.elevation, to.bearing.elevation, part)};
  state.roll = mixed(from.roll, to.roll, part);
  state.lens.focal = mixed_logarithm(from.lens.focal, to.lens.focal, part);
  state.lens.aspect = mixed_logarithm(from.lens.aspect, to.lens.aspect, part);
  state.lens.offset = from.lens.offset + (to.lens.offset - from.lens.offset) * part;
  if (about == GlideAbout::target) {
    state.target = from.target + (to.target - from.target) * part;
  } else {
    const glm::dvec3 eye = eye_of(from);
    place_eye(state, eye + (eye_of(to) - eye) * part);
  }
  return state;
}

double difference(const ViewState& a, const ViewState& b) {
  const double distance = std::min(a.distance, b.distance);
  return std::max({std::abs(a.bearing.azimuth - b.bearing.azimuth),
                   std::abs(a.bearing.elevation - b.bearing.elevation), std::abs(a.roll - b.roll),
                   std::abs(std::log(a.distance / b.distance)),
                   glm::length(a.target - b.target) / distance,
                   glm::length(eye_of(a) - eye_of(b)) / distance,
                   std::abs(std::log(a.lens.focal / b.lens.focal)),
                   std::abs(std::log(a.lens.aspect / b.lens.aspect)),
                   glm::length(a.lens.offset - b.lens.offset)});
}

}  // namespace tureen
