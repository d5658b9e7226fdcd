#include "camera/up_axis.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/decimal_text.hpp"
#include "camera/angles.hpp"

namespace tureen {

namespace {

std::optional<glm::dvec3> unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return v / length;
}

std::optional<UpGuess> from_cameras(std::span<const Camera> cameras) {
  glm::dvec3 sum(0);
  for (const Camera& camera : cameras)
    if (const auto up = unit(camera.world_from_view_rotation()[1])) sum += *up;
  // Agreement of three cameras is unlikely by chance. For random axes, the mean is shorter than
  // half.
  if (cameras.size() < 3 || !(glm::length(sum) > 0.5 * double(cameras.size()))) return {};
  const glm::dvec3 mean = glm::normalize(sum), axis = nearest_axis(mean);
  const double angle = std::acos(std::min(1.0, glm::dot(mean, axis)));
  if (!(angle < 25 * degree)) return UpGuess{mean, UpGuess::Reason::cameras, cameras.size()};
  return UpGuess{axis, UpGuess::Reason::cameras_near_axis, cameras.size(), angle / degree};
}

std::optional<UpGuess> from_box(const glm::dvec3& extent) {
  if (!std::isfinite(extent.x + extent.y + extent.z)) return {};
  for (int side = 0; side < 3; ++side) {
    const double other = std::min(extent[(side + 1) % 3], extent[(side + 2) % 3]);
    if (!(other > 0) || !(extent[side] < other / 3)) continue;
    glm::dvec3 axis(0);
    axis[side] = 1;
    return UpGuess{axis, UpGuess::Reason::flat};
  }
  return {};
}

}  // namespace

UpEvidence evidence_of(const Scene& scene, const Subject& subject) {
  return {.stored = glm::dvec3(scene.info.up),
          .stored_is_assumed = scene.info.up_is_assumed,
          .cameras = scene.cameras,
          .extent = subject.high - subject.low};
}

UpGuess guess_up(const UpEvidence& evidence) {
  const auto stored = unit(evidence.stored);
  if (stored && !evidence.stored_is_assumed) return {*stored, UpGuess::Reason::stored};
  if (const auto guess = from_cameras(evidence.cameras)) return *guess;
  // A box that is flat along the assumed axis confirms it, and the assumed sign is kept.
  const auto flat = from_box(evidence.extent);
  if (flat && !(stored && std::abs(glm::dot(*stored, flat->axis)) > 0.999)) return *flat;
  if (stored) return {*stored, UpGuess::Reason::assumed};
  return {};
}

std::string describe(const UpGuess& guess) {
  const std::string axis = axis_name(guess.axis);
  const std::string mean =
      "the mean of the up axes of " + std::to_string(guess.cameras) + " cameras ";
  switch (guess.reason) {
    case UpGuess::Reason::stored:
      return "the file stores " + axis + " as the up axis";
    case UpGuess::Reason::cameras_near_axis:
      return mean + "points " + fixed_decimal(guess.degrees, 0) + " degrees from " + axis +
             ", the assumed up axis";
    case UpGuess::Reason::cameras:
      return mean + "is the assumed up axis: " + axis;
    case UpGuess::Reason::flat:
      return "the scene is flat along " + axis + ", the assumed up axis; it may also be " +
             axis_name(-guess.axis);
    case UpGuess::Reason::assumed:
    case UpGuess::Reason::nothing:
      return "the up axis is unknown; " + axis + " is assumed";
  }
  return "";
}

}  // namespace tureen
