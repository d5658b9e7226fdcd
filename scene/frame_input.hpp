// The input of a frame, for everything that draws: renderers, debug views, the oracle.
#pragma once

#include "scene/camera.hpp"

namespace tureen {

struct FrameInput {
  Camera camera;    // in world coordinates
  double time = 0;  // seconds from the start of the scene; no primitive depends on it yet
};

}  // namespace tureen
