// A renderer of one soup, planned for the context's device.
#pragma once

#include "runtime/renderer.hpp"

namespace tureen {

inline Renderer renderer_of(const gl::Context& context, const TriangleSoup& soup,
                            glm::dvec3 origin = {}, const RenderOptions& options = {}) {
  return Renderer(context,
                  prepare_scene(soup, origin, device_limits(context.capabilities()), options),
                  options);
}

}  // namespace tureen
