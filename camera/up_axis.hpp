// The up axis of a scene whose file may not store it: a guess with its reason.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "camera/navigation.hpp"
#include "scene/camera.hpp"
#include "scene/scene.hpp"
#include "scene/similarity.hpp"

namespace tureen {

/// The available evidence. Any part may be missing.
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
    stored,             // stored in the file
    cameras_near_axis,  // a coordinate axis; the mean of the cameras' up axes lies near it
    cameras,            // that mean
    flat,               // along the short side of the box; the sign of the direction is a guess
    assumed,            // the reader's assumption
    nothing             // no evidence: y
  };
  glm::dvec3 axis{0, 1, 0};  // of unit length
  Reason reason = Reason::nothing;
  std::size_t cameras = 0;  // their number, if they are the reason
  double degrees = 0;       // between their mean and the axis
};

/// The reason in a sentence, without a full stop.
std::string describe(const UpGuess& guess);

/// The rules, in this order:
/// - The axis stored in the file.
/// - The mean of the cameras' up axes, if there are at least three cameras and the mean is longer
///   than half of unit length: people hold cameras upright. If the cameras point down and stand on
///   only one side of the scene, their tilts do not cancel, and the mean is tilted. In aligned
///   scenes, the up axis is a coordinate axis. A mean within 25 degrees of a coordinate axis is
///   therefore replaced by that axis.
/// - The side of the box that is less than a third of both others: places are flat. If the reader
///   assumed an axis along this side, its sign is kept.
/// - The reader's assumption; without one, y.
/// Non-finite values count as missing.
UpGuess guess_up(const UpEvidence& evidence);

}  // namespace tureen
