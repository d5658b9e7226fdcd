#include "camera/camera_controls.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "camera/angles.hpp"
#include "camera/capture.hpp"
#include "scene/finite.hpp"

namespace tureen {

namespace {

using std::numbers::pi;

// The reason for this limit: orbit() in the header.
constexpr double highest_elevation = 89.9 * degree;

// Nearer to the target, single texels fill the image; farther away, the scene is smaller than a
// pixel. The limits also keep every wheel movement reversible.
constexpr double nearest_radii = 1e-5, farthest_radii = 1e4, farthest_target_radii = 1e5;

constexpr double dolly_factor = 0.9, speed_factor = 1.2;

// Limits per event, above those of any device. Powers of larger numbers would overflow.
constexpr double max_steps = 1000, max_pixels = 1e7;

// Gliding ends below this difference: 1e-5 radians are a twentieth of a pixel at a focal length of
// 5,000 pixels.
constexpr double arrived = 1e-5;

bool is_delta(double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (x != 0 || y != 0);
}

double within(double value, double most) { return std::clamp(value, -most, most); }

/// `wanted` clamped to low..high. If `now` lies outside, the range extends to `now`.
double limited(double wanted, double now, double low, double high) {
  return std::clamp(wanted, std::min(low, now), std::max(high, now));
}

double seconds_factor(double seconds, double time_constant) {
  return time_constant > 0 ? -std::expm1(-seconds / time_constant) : 1.0;
}

bool is_sound(const Camera& camera) {
  bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.cx) &&
                std::isfinite(camera.cy);
  for (int column = 0; column < 4; ++column)
    finite = finite && is_finite(glm::dvec3(camera.view_from_world[column]));
  return finite && camera.width > 0 && camera.height > 0 && camera.fx > 0 && camera.fy > 0;
}

struct NamedBearing {
  const char *name, *key;
  Bearing bearing;
};

constexpr std::array<NamedBearing, named_views.size()> named_bearings{{
    {"front", "front", {0, 0}},
    {"back", "back", {pi, 0}},
    {"left", "left", {-0.5 * pi, 0}},
    {"right", "right", {0.5 * pi, 0}},
    {"top", "top", {0, 0.5 * pi}},
    {"bottom", "bottom", {0, -0.5 * pi}},
    {"three-quarter", "three-quarter", three_quarter_view},
    {"three-quarter left",
     "three-quarter-left",
     {-three_quarter_view.azimuth, three_quarter_view.elevation}},
    {"three-quarter back",
     "three-quarter-back",
     {three_quarter_view.azimuth + pi, three_quarter_view.elevation}},
}};

}  // namespace

const char* name_of(NamedView view) { return named_bearings[std::size_t(view)].name; }

const char* key_of(NamedView view) { return named_bearings[std::size_t(view)].key; }

Bearing bearing_of(NamedView view) { return named_bearings[std::size_t(view)].bearing; }

CameraControls::CameraControls(const Subject& subject) {
  set_subject(subject);
  goal_.up = shown_.up = first_up_;
  speed_ = 0.5 * radius_;
  home();
  arrive();
}

void CameraControls::set_viewport(int width, int height) {
  const glm::dvec2 viewport(width, height);
  if (width <= 0 || height <= 0 || viewport == viewport_) return;
  viewport_ = viewport;
  if (!at_first_view_ || !first_view_) return;
  const bool arrived = !moving_;
  reset();
  if (arrived) arrive();
}

void CameraControls::set_subject(const Subject& subject) {
  const double length = glm::length(subject.up);
  if (length > 0 && std::isfinite(length)) first_up_ = subject.up / length;
  set_box(subject.low, subject.high);
}

void CameraControls::set_box(const glm::dvec3& low, const glm::dvec3& high) {
  low_ = low;
  high_ = high;
  const glm::dvec3 center = 0.5 * low + 0.5 * high;
  radius_ = 0.5 * glm::length(high - low);
  if (std::isfinite(radius_) && radius_ > 0 && is_finite(center)) return;
  radius_ = 1;
  low_ = (is_finite(center) ? center : glm::dvec3(0)) - glm::dvec3(std::sqrt(1.0 / 3.0));
  high_ = low_ + glm::dvec3(2 * std::sqrt(1.0 / 3.0));
}

bool CameraControls::usable(const ViewState& next) const {
  if (!is_finite(next.target) || !is_finite(eye_of(next)) || !(next.distance > 0)) return false;
  const glm::dvec3 center = 0.5 * low_ + 0.5 * high_;
  const double far = glm::length(next.target - center);
  return far <= farthest_target_radii * radius_ || far <= glm::length(goal_.target - center);
}

void CameraControls::move_to(const ViewState& next) {
  if (!usable(next)) return;
  adopted_.reset();
  at_first_view_ = false;
  goal_ = next;
  // Whole turns are removed after 100 turns, since large angles lose precision: 100 turns cost
  // three of sixteen digits.
  const double turns = 2 * pi * std::round(shown_.bearing.azimuth / (2 * pi));
  if (std::abs(turns) > 200 * pi) {
    goal_.bearing.azimuth -= turns;
    shown_.bearing.azimuth -= turns;
  }
  moving_ = true;
  if (!(smoothing_ > 0)) arrive();
}

void CameraControls::travel_to(const ViewState& next) {
  ViewState short_way = next;
  take_short_way(short_way, shown_);
  move_to(short_way);
}

void CameraControls::drag(double dx, double dy) {
  mode_ == NavigationMode::orbit ? orbit(dx, dy) : look(dx, dy);
}

void CameraControls::wheel(double steps, glm::dvec2 pointer) {
  mode_ == NavigationMode::orbit ? dolly(steps, pointer) : scale_speed(steps);
}

ViewState CameraControls::turned(double dx, double dy, double radians_per_pixel) const {
  dx = within(dx, max_pixels);
  dy = within(dy, max_pixels);
  ViewState next = goal_;
  next.bearing.azimuth -= dx * radians_per_pixel;
  next.bearing.elevation = limited(next.bearing.elevation + dy * radians_per_pixel,
                                   next.bearing.elevation, -highest_elevation, highest_elevation);
  next.roll *= std::exp(-std::hypot(dx, dy) / (roll_fade * viewport_.y));
  return next;
}

void CameraControls::orbit(double dx, double dy) {
  if (is_delta(dx, dy)) move_to(turned(dx, dy, pi / viewport_.y));
}

void CameraControls::look(double dx, double dy) {
  if (!is_delta(dx, dy)) return;
  const double narrow = std::min(1.0, goal_.lens.fov_y() / (40 * degree));
  ViewState next = turned(dx, dy, narrow * pi / viewport_.y);
  place_eye(next, eye_of(goal_));
  move_to(next);
}

void CameraControls::pan(double dx, double dy) {
  if (!is_delta(dx, dy)) return;
  const glm::dmat3 axes = rotation_of(goal_);
  const double a_pixel = goal_.distance / (goal_.lens.focal * viewport_.y);
  ViewState next = goal_;
  next.target += a_pixel * (within(dy, max_pixels) * axes[1] -
                            within(dx, max_pixels) / goal_.lens.aspect * axes[0]);
  move_to(next);
}

void CameraControls::dolly(double steps) { dolly_about(steps, -rotation_of(goal_)[2]); }

void CameraControls::dolly(double steps, glm::dvec2 pointer) {
  if (!std::isfinite(pointer.x) || !std::isfinite(pointer.y)) return;
  const ViewLens& lens = goal_.lens;
  const glm::dvec2 from_axis = (pointer - 0.5 * viewport_) / viewport_.y - lens.offset;
  dolly_about(steps, rotation_of(goal_) * glm::dvec3(from_axis.x / (lens.focal * lens.aspect),
                                                     -from_axis.y / lens.focal, -1.0));
}

/// The image position of the ray's point at the target's depth is unchanged. `fixed_ray` has depth
/// 1.
void CameraControls::dolly_about(double steps, const glm::dvec3& fixed_ray) {
  if (!is_delta(steps, 0)) return;
  ViewState next = goal_;
  next.distance = limited(goal_.distance * std::pow(dolly_factor, within(steps, max_steps)),
                          goal_.distance, nearest_radii * radius_, farthest_radii * radius_);
  place_eye(next, eye_of(goal_) + (goal_.distance - next.distance) * fixed_ray);
  move_to(next);
}

void CameraControls::scale_speed(double steps) {
  if (std::isfinite(steps))
    speed_ = limited(speed_ * std::pow(speed_factor, within(steps, max_steps)), speed_,
                     nearest_radii * radius_, 1e3 * radius_);
}

void CameraControls::advance(double seconds, const Flight& flight) {
  if (!(seconds > 0) || !std::isfinite(seconds)) return;
  const double push = glm::length(flight.direction);
  glm::dvec3 velocity(0);
  if (push > 0 && std::isfinite(push) && flight.factor > 0 && std::isfinite(flight.factor))
    velocity =
        speed_ * flight.factor * (rotation_of(goal_) * flight.direction) / std::max(push, 1.0);
  const bool flies = velocity != glm::dvec3(0);
  if (!flies && !moving_) return;

  // Let d be the shown view minus the goal, and v the goal's velocity. Then d' = -d / tau - v, so
  // d(t) = d(0) exp(-t / tau) - v tau (1 - exp(-t / tau)).
  const double part = seconds_factor(seconds, smoothing_);
  const GlideAbout about = mode_ == NavigationMode::orbit ? GlideAbout::target : GlideAbout::eye;
  ViewState shown = between(shown_, goal_, part, about);
  if (flies) {
    ViewState next = goal_;
    next.target += seconds * velocity;
    if (usable(next)) {
      shown.target += (seconds - smoothing_ * part) * velocity;
      move_to(next);
    }
  }
  if (!moving_) return;  // without smoothing move_to has arrived
  shown_ = shown;
  if (!flies && !(difference(shown_, goal_) >= arrived)) arrive();
}

void CameraControls::set_smoothing(double seconds) {
  if (!(seconds >= 0) || !std::isfinite(seconds)) return;
  smoothing_ = seconds;
  if (!(smoothing_ > 0)) arrive();
}

void CameraControls::arrive() {
  shown_ = goal_;
  moving_ = false;
}

void CameraControls::show_box(ViewState next, const glm::dvec3& low, const glm::dvec3& high) {
  next.roll = 0;
  next.lens.aspect = 1;
  next.lens.offset = {0, 0};
  const Lens lens{
      .width = int(viewport_.x), .height = int(viewport_.y), .fov_y = next.lens.fov_y()};
  next.target = 0.5 * low + 0.5 * high;
  // The minimum distance applies to a point, which has no size to frame.
  next.distance =
      std::max(framing_distance({low, high, next.up}, rotation_of(next), lens), 1e-3 * radius_);
  travel_to(next);
}

void CameraControls::frame() { frame(low_, high_); }

void CameraControls::frame(const glm::dvec3& low, const glm::dvec3& high) {
  if (is_finite(low) && is_finite(high)) show_box(goal_, low, high);
}

void CameraControls::look_from(NamedView view) {
  ViewState next = goal_;
  next.bearing = bearing_of(view);
  show_box(next, low_, high_);
}

void CameraControls::home() {
  ViewState next{.up = goal_.up, .bearing = three_quarter_view};
  show_box(next, low_, high_);
}

void CameraControls::reset() {
  set_up(first_up_);
  first_view_ ? adopt(whole_in(viewport_, *first_view_)) : home();
  at_first_view_ = true;
}

void CameraControls::focus(const glm::dvec3& point) {
  const double depth = -glm::dot(point - eye_of(goal_), rotation_of(goal_)[2]);
  if (!(depth > 0) || !std::isfinite(depth)) return;
  ViewState next = goal_;
  next.target = point;
  next.distance = depth;
  move_to(next);
}

void CameraControls::set_target_depth(double depth) {
  if (!(depth > 0) || !std::isfinite(depth)) return;
  const auto at_depth = [&](ViewState state) {
    const glm::dvec3 eye = eye_of(state);
    state.distance = depth;
    place_eye(state, eye);
    return state;
  };
  if (!usable(at_depth(goal_))) return;
  at_first_view_ = false;
  goal_ = at_depth(goal_);
  shown_ = at_depth(shown_);
}

void CameraControls::set_up(const glm::dvec3& up) {
  const double length = glm::length(up);
  if (!(length > 0) || !std::isfinite(length)) return;
  const glm::dvec3 axis = up / length;
  shown_ = with_up(shown_, axis);
  ViewState next = goal_;
  next.up = axis;
  next.roll = 0;
  goal_.up = axis;  // goal_ and shown_ have the same axis even if travel_to() ignores `next`
  travel_to(next);
}

void CameraControls::adopt(const Camera& camera) {
  if (!is_sound(camera)) return;
  const glm::dvec3 center = 0.5 * low_ + 0.5 * high_;
  const double depth = -glm::dot(center - camera.eye(), camera.world_from_view_rotation()[2]);
  ViewState next = state_of(camera, goal_.up, std::max(depth, 0.1 * radius_));
  // Rejects invalid axes and lengths whose squares overflow. The distance is not limited, since a
  // recorded camera is shown as it is.
  if (!std::isfinite(difference(next, goal_))) return;
  take_short_way(next, shown_);
  goal_ = next;
  adopted_ = camera;
  at_first_view_ = false;
  moving_ = true;
  if (!(smoothing_ > 0)) arrive();
}

void CameraControls::set_fov(double fov_y) {
  if (!std::isfinite(fov_y)) return;
  ViewState next = goal_;
  next.lens.focal = lens_of_angle(std::clamp(fov_y, 0.1 * degree, 170 * degree)).focal;
  move_to(next);
}

Camera CameraControls::camera(int width, int height) const {
  assert(width > 0 && height > 0);
  if (!shows_adopted()) return camera_of(shown_, width, height);
  if (width == adopted_->width && height == adopted_->height) return *adopted_;
  return resized(*adopted_, width, height);
}

}  // namespace tureen
