// The input of a frame, for everything that draws: renderers, debug views, the oracle.
#pragma once

#include <optional>

#include "scene/camera.hpp"

namespace tureen {

struct FrameInput {
  Camera camera;    // in world coordinates
  double time = 0;  // seconds from the start of the scene; no primitive depends on it yet
  /// If this frame is a tile of a larger image: the camera of that image. The rules of some splats
  /// depend on the image's size (SplatProfile::Projection::ewa).
  std::optional<Camera> whole = {};

  bool operator==(const FrameInput&) const = default;
};

}  // namespace tureen
