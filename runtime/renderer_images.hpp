// The runtime's images of a scene for measurements: with colours over the background, and coverage.
#pragma once

#include "runtime/renderer.hpp"
#include "scene/image_source.hpp"

namespace tureen {

class RendererImages final : public ImageSource {
 public:
  /// `renderer` outlives the object, which changes its background. Images are at most as large as
  /// the device allows.
  RendererImages(Renderer& renderer, const glm::vec3& background)
      : renderer_(renderer), background_(background) {}

  /// Draws two frames: one over the opaque background, one for the coverage. Throws
  /// DeviceLimitError.
  Image8 image(const FrameInput& input) override;

 private:
  Renderer& renderer_;
  glm::vec3 background_;
};

}  // namespace tureen
