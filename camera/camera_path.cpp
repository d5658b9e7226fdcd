#include "camera/camera_path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "camera/angles.hpp"
#include "camera/camera_spline.hpp"
#include "camera/view_state.hpp"

namespace tureen {

namespace {

constexpr int keyframes_a_turn =
    8;  // steps far below half a turn, where the short way is ambiguous

}  // namespace

CameraPath::CameraPath(CameraPathData data) : data_(std::move(data)) { make_curves(); }

double CameraPath::begin() const { return empty() ? 0 : data_.keyframes.front().seconds; }

double CameraPath::duration() const {
  if (empty()) return 0;
  return std::max(data_.keyframes.back().seconds - begin(), data_.loop_seconds);
}

// --- Curves ---------------------------------------------------------------------------------

void CameraPath::make_curves() {
  auto& keyframes = data_.keyframes;
  std::stable_sort(
      keyframes.begin(), keyframes.end(),
      [](const CameraKeyframe& a, const CameraKeyframe& b) { return a.seconds < b.seconds; });
  about_targets_ = std::all_of(keyframes.begin(), keyframes.end(),
                               [](const CameraKeyframe& k) { return k.target_distance > 0; });
  knots_.clear();
  for (const CameraKeyframe& keyframe : keyframes) knots_.push_back(knot_of(keyframe));
  // The derivative at an end depends on the one at the other end of its span.
  for (std::size_t i = 0; i < knots_.size(); ++i) take_rate(i);
  for (std::size_t i = 0; i < knots_.size(); ++i) take_end_rate(i);
}

CameraPath::Knot CameraPath::knot_of(const CameraKeyframe& keyframe) const {
  const Camera& camera = keyframe.camera;
  assert(camera.width > 0 && camera.height > 0 && camera.fx > 0 && camera.fy > 0);
  assert(std::isfinite(keyframe.seconds));
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const double distance = about_targets_ ? keyframe.target_distance : 1.0;
  const ViewLens lens = lens_of(camera);
  Knot knot;
  knot.seconds = keyframe.seconds;
  knot.point = camera.eye();
  if (about_targets_) knot.point -= distance * axes[2];
  knot.rotation = glm::normalize(glm::quat_cast(axes));
  knot.values = {std::log(distance), std::log(lens.focal), std::log(lens.aspect), lens.offset.x,
                 lens.offset.y};
  return knot;
}

double CameraPath::span_after(std::size_t index) const {
  if (knots_.size() < 2) return 0;
  const bool last = index + 1 == knots_.size();
  if (last && !is_loop()) return 0;
  const double span =
      knots_[next(index)].seconds - knots_[index].seconds + (last ? data_.loop_seconds : 0.0);
  return span >= shortest_span ? span : 0;
}

CameraPath::Change CameraPath::change(const Knot& from, const Knot& to) {
  Change result;
  result.point = to.point - from.point;
  result.turn = rotation_vector(glm::conjugate(from.rotation) * to.rotation);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = to.values[i] - from.values[i];
  return result;
}

/// Sets the derivative of a knot with spans on both sides.
void CameraPath::take_rate(std::size_t index) {
  const double before = span_after(previous(index)), after = span_after(index);
  if (!(before > 0 && after > 0)) return;
  Knot& knot = knots_[index];
  const Change came = change(knots_[previous(index)], knot);
  const Change goes = change(knot, knots_[next(index)]);
  const auto rate = [&](const auto& a, const auto& b) {
    return joint_derivative({a, before}, {b, after});
  };
  // A rotation vector is the same in the axes of both its ends, so both are in this knot's axes.
  knot.rate.point = rate(came.point, goes.point);
  knot.rate.turn = rate(came.turn, goes.turn);
  for (std::size_t i = 0; i < knot.values.size(); ++i)
    knot.rate.values[i] = rate(came.values[i], goes.values[i]);
}

/// Sets the derivative of a knot with a span on one side only.
void CameraPath::take_end_rate(std::size_t index) {
  const double before = span_after(previous(index)), after = span_after(index);
  if ((before > 0) == (after > 0)) return;
  const std::size_t other = after > 0 ? next(index) : previous(index);
  const double seconds = std::max(before, after);
  const bool alone = !(span_after(other) > 0 && span_after(previous(other)) > 0);
  Knot& knot = knots_[index];
  const Change way = after > 0 ? change(knot, knots_[other]) : change(knots_[other], knot);
  const auto rate = [&](const auto& difference, const auto& rate_there) {
    // An isolated span has constant speed.
    return alone ? (1 / seconds) * difference : end_derivative({difference, seconds}, rate_there);
  };
  const Change& there = knots_[other].rate;
  knot.rate.point = rate(way.point, there.point);
  knot.rate.turn = rate(way.turn, there.turn);
  for (std::size_t i = 0; i < knot.values.size(); ++i)
    knot.rate.values[i] = rate(way.values[i], there.values[i]);
}

CameraPath::Knot CameraPath::between(const Knot& a, const Knot& b, double seconds, double part) {
  Knot knot;
  knot.point = hermite<glm::dvec3>({a.point, a.rate.point}, {b.point, b.rate.point}, seconds, part);
  knot.rotation = hermite({a.rotation, a.rate.turn}, {b.rotation, b.rate.turn}, seconds, part);
  for (std::size_t i = 0; i < knot.values.size(); ++i)
    knot.values[i] = hermite<double>({a.values[i], a.rate.values[i]},
                                     {b.values[i], b.rate.values[i]}, seconds, part);
  return knot;
}

Camera CameraPath::at(double seconds, int width, int height) const {
  assert(!empty() && width > 0 && height > 0);
  double clock = seconds - begin();
  if (is_loop()) clock -= duration() * std::floor(clock / duration());
  // NaN and -infinity become the beginning; so does +infinity in a loop. The remainder may round up
  // to the duration.
  if (!(clock > 0)) clock = std::isinf(seconds) && seconds > 0 && !is_loop() ? duration() : 0.0;
  clock = std::min(clock, duration()) + begin();

  const auto after =
      std::upper_bound(knots_.begin(), knots_.end(), clock,
                       [](double time, const Knot& knot) { return time < knot.seconds; });
  const std::size_t index = after == knots_.begin() ? 0 : std::size_t(after - knots_.begin()) - 1;
  const Knot& from = knots_[index];
  const double span = span_after(index);
  const Knot knot =
      span > 0 ? between(from, knots_[next(index)], span, (clock - from.seconds) / span) : from;

  const glm::dmat3 axes = glm::mat3_cast(knot.rotation);
  const ViewLens lens{.focal = std::exp(knot.values[1]),
                      .aspect = std::exp(knot.values[2]),
                      .offset = {knot.values[3], knot.values[4]}};
  glm::dvec3 eye = knot.point;
  if (about_targets_) eye += std::exp(knot.values[0]) * axes[2];
  return camera_of(lens, axes, eye, width, height);
}

// --- Editing --------------------------------------------------------------------------------

std::size_t CameraPath::add(const CameraKeyframe& keyframe) {
  auto& keyframes = data_.keyframes;
  const auto place = std::upper_bound(
      keyframes.begin(), keyframes.end(), keyframe,
      [](const CameraKeyframe& a, const CameraKeyframe& b) { return a.seconds < b.seconds; });
  const std::size_t index = std::size_t(place - keyframes.begin());
  keyframes.insert(place, keyframe);
  make_curves();
  return index;
}

void CameraPath::replace(std::size_t index, const CameraKeyframe& keyframe) {
  assert(index < data_.keyframes.size());
  const double seconds = data_.keyframes[index].seconds;
  data_.keyframes[index] = keyframe;
  data_.keyframes[index].seconds = seconds;
  make_curves();
}

void CameraPath::remove(std::size_t index) {
  assert(index < data_.keyframes.size());
  data_.keyframes.erase(data_.keyframes.begin() + std::ptrdiff_t(index));
  make_curves();
}

std::size_t CameraPath::move(std::size_t index, double seconds) {
  assert(index < data_.keyframes.size());
  CameraKeyframe keyframe = data_.keyframes[index];
  keyframe.seconds = seconds;
  remove(index);
  return add(keyframe);
}

void CameraPath::set_loop_seconds(double seconds) {
  assert(seconds >= 0 && std::isfinite(seconds));
  data_.loop_seconds = seconds;
  make_curves();
}

// --- Generated paths ------------------------------------------------------------------------

CameraPathData turntable(const Turntable& options) {
  assert(options.distance > 0 && options.seconds > 0 && options.turns != 0);
  const Camera& first = options.first;
  const glm::dmat3 axes = first.world_from_view_rotation();
  const glm::dvec3 eye = first.eye(), target = eye - options.distance * axes[2];
  const glm::dvec3 up = glm::normalize(options.up);
  const int count = keyframes_a_turn * std::abs(options.turns);
  CameraPathData path;
  path.loop_seconds = options.seconds;
  for (int i = 0; i < count; ++i) {
    const double part = double(i) / count;
    const glm::dmat3 turned =
        glm::mat3_cast(rotation_of_vector(full_turn * options.turns * part * up)) * axes;
    Camera camera = camera_of(lens_of(first), turned, target + options.distance * turned[2],
                              first.width, first.height);
    camera.name = "turntable " + std::to_string(i);
    path.keyframes.push_back(
        {std::move(camera), options.first_seconds + options.seconds * part, options.distance});
  }
  return path;
}

CameraPathData turntable(const Subject& subject, const Bearing& start, const Lens& lens,
                         double seconds) {
  // With 72 directions, the framing distance changes by less than 1 % between neighbours.
  constexpr int directions = 72;
  double distance = 0;
  for (int i = 0; i < directions; ++i)
    distance =
        std::max(distance,
                 framing_distance(
                     subject, {start.azimuth + full_turn * i / directions, start.elevation}, lens));
  const double length = glm::length(subject.up);
  const glm::dvec3 up = length > 0 ? subject.up / length : glm::dvec3(0, 1, 0);
  const ViewState first{.up = up,
                        .target = subject.center(),
                        .distance = distance,
                        .bearing = start,
                        .lens = lens_of_angle(lens.fov_y)};
  return turntable({.first = camera_of(first, lens.width, lens.height),
                    .distance = distance,
                    .up = up,
                    .seconds = seconds});
}

double frame_count(const CameraPath& path, double frames_per_second) {
  assert(frames_per_second > 0);
  if (path.empty()) return 0;
  const double exact = path.duration() * frames_per_second;
  if (path.is_loop()) return std::max(1.0, std::round(exact));
  // The constant compensates for rounding just below a whole number.
  return std::floor(exact + 1e-6) + 1;
}

std::vector<Camera> frames(const CameraPath& path, const FrameRate& rate) {
  const double count = frame_count(path, rate.frames_per_second);
  std::vector<Camera> cameras;
  for (double i = 0; i < count; ++i) {
    // The frames of a loop divide its duration evenly, so that the last one joins the first.
    const double clock = path.is_loop() ? path.duration() * i / count : i / rate.frames_per_second;
    cameras.push_back(path.at(path.begin() + clock, rate.width, rate.height));
    cameras.back().name = "frame " + std::to_string(cameras.size() - 1);
  }
  return cameras;
}

}  // namespace tureen
