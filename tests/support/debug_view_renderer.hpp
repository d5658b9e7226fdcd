// A renderer of one soup that shows its debug views.
#pragma once

#include "runtime/debug_views/debug_views.hpp"

namespace tureen {

class DebugViewRenderer {
 public:
  DebugViewRenderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                    const RenderOptions& options = {})
      : DebugViewRenderer(context, placed_layer(soup, origin), options) {}

  void show(DebugView what, const FeatureChoice& features = {}) {
    views_.show(renderer_, what, features);
  }
  Renderer& renderer() { return renderer_; }
  const Renderer& renderer() const { return renderer_; }
  std::vector<std::uint8_t> read_fragment_counts() const { return views_.read_fragment_counts(); }
  Legend legend() const { return views_.legend(); }

 private:
  DebugViewRenderer(const gl::Context& context, const PlacedLayer& layer,
                    const RenderOptions& options)
      : views_(std::span(&layer, 1)),
        renderer_(context,
                  prepare_debug_views(std::span(&layer, 1), device_limits(context.capabilities()),
                                      options),
                  options) {}

  DebugViews views_;
  Renderer renderer_;
};

}  // namespace tureen
