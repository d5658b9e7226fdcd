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

/// The visible faces of the last frame of a scene with one layer.
inline std::vector<std::uint32_t> faces_of(const Renderer& renderer) {
  std::vector<std::uint32_t> faces;
  for (const VisibleFace& visible : renderer.read_faces()) faces.push_back(visible.face);
  return faces;
}

}  // namespace tureen
