// Scenes of splats alone, drawn on the processor without OpenGL, as TilePass blends them.
#pragma once

#include <memory>
#include <vector>

#include "base/threads/thread_pool.hpp"
#include "scene/image_source.hpp"
#include "scene/layer_place.hpp"
#include "scene/scene.hpp"
#include "splatting/tiles/tile_renderer.hpp"

namespace tureen {

class TileImages final : public ImageSource {
 public:
  /// `scene` outlives the object. Images are over the background, or have the colours of the
  /// covered part without one. The visible layers of `scene` have no defect(). Throws UsageError if
  /// one of them is a soup, or has more splats than splatting::has_layer_for() allows.
  TileImages(const Scene& scene, std::optional<glm::vec3> background,
             splatting::BlendOrder order = splatting::BlendOrder::centers);

  Image8 image(const FrameInput& input) override { return quantised(*exact_image(input)); }
  std::optional<ImageF> exact_image(const FrameInput& input) override;

 private:
  struct TiledLayer {
    std::unique_ptr<splatting::Layer> splats;
    const SplatProfile* profile;
    LayerPlace place;
  };

  std::optional<glm::vec3> background_;
  splatting::BlendOrder order_;
  ThreadPool pool_;
  splatting::TileRenderer renderer_;
  std::vector<TiledLayer> layers_;
};

}  // namespace tureen
