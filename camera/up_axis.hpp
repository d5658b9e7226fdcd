// Which way is up in a scene whose file need not say: a guess, and its reason for the person who
// may know better.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>

#include "camera/navigation.hpp"
#include "scene/camera.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// What is known. Anything may be missing.
struct UpEvidence {
  glm::dvec3 stored{0.0};          // SceneInfo::up; (0, 0, 0): nothing
  bool stored_is_assumed = false;  // SceneInfo::up_is_assumed
  std::span<const Camera> cameras = {};
  glm::dvec3 extent{0.0};  // the sides of the scene's box
};

/// A scene's evidence. `subject` is subject_of(scene); the scene must outlive the evidence.
UpEvidence evidence_of(const Scene& scene, const Subject& subject);

struct UpGuess {
  enum class Reason {
    stored,             // the file says so
    cameras_near_axis,  // the mean of the cameras' up axes lies near it
    cameras,            // it is that mean
    flat,               // along the short side of the box, whose sign is a guess
    assumed,            // by the reader
    nothing             // y
  };
  glm::dvec3 axis{0, 1, 0};  // of unit length
  Reason reason = Reason::nothing;
  std::size_t cameras = 0;  // how many, where they are the reason
  double degrees = 0;       // between their mean and the axis
};

/// The reason in a sentence, without a full stop.
std::string describe(const UpGuess& guess);

/// In this order:
/// - What the file itself says.
/// - The mean of the cameras' up axes, for people hold cameras upright, where at least three
///   cameras leave half of its length. Who walks round only a part of the scene and looks down
///   tilts the mean by as much, and scenes that were aligned have an axis up: within 25 degrees of
///   an axis it is that axis.
/// - The one side of the box that is less than a third of both others: places are flat.
/// - What the reader assumed; y where there is not even that.
/// What is not finite counts as missing.
UpGuess guess_up(const UpEvidence& evidence);

/// "x", "-y"; "(0.1, 0.9, 0.4)" for what lies along no axis to 1e-6.
std::string axis_name(const glm::dvec3& axis);

}  // namespace tureen
