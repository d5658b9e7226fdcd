// Vertex positions that geometry.vert computes on the device, read back by transform feedback.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "runtime/passes/pass.hpp"

namespace tureen::test {

/// gl_Position of each vertex. Makes the shared context current.
std::vector<glm::vec4> clip_positions(const FrameCamera& frame, const glm::dmat4& clip_from_view,
                                      const std::vector<glm::vec3>& positions);

}  // namespace tureen::test
