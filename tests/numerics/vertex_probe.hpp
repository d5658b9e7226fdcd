// Where geometry.vert puts vertices on the device, read back by transform feedback.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "runtime/passes/pipeline.hpp"

namespace tureen::test {

/// gl_Position of each; the shared context is current.
std::vector<glm::vec4> clip_positions(const FrameCamera& frame, const glm::dmat4& clip_from_view,
                                      const std::vector<glm::vec3>& positions);

}  // namespace tureen::test
