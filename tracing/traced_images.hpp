// Images by rays. Primary rays draw what the rasteriser draws, with the splats of each pixel in
// their exact order (splatting::BlendOrder::along_rays), in front of the nearest surface on the
// pixel's ray; mirrors and glass send further rays (tracing/traced_scene.hpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/threads/thread_pool.hpp"
#include "scene/image_source.hpp"
#include "scene/layer_place.hpp"
#include "scene/scene.hpp"
#include "splatting/tiles/tile_renderer.hpp"
#include "tracing/traced_scene.hpp"

namespace tureen::tracing {

struct TraceOptions {
  /// Samples of a pixel: one at its centre, or more, jittered over the pixel; the image is their
  /// mean. Low passes of splats are in pixels, whatever the number.
  int samples = 1;
  /// Samples on a regular grid instead: supersampling^2. Only with one jittered sample.
  int supersampling = 1;
  /// Nullopt: transparent; mirrors and glass then show black behind the scene.
  std::optional<glm::vec3> background = glm::vec3(0.0f);
  int threads = 0;  // 0: all cores; no result depends on it
  /// Called with the fraction done, 0..1, by the caller's thread; may throw to cancel. Then an
  /// image with complete samples is their mean, and another one throws.
  std::function<void(double)> progress = {};
};

class TracedImages final : public ImageSource {
 public:
  /// Without layers.
  explicit TracedImages(TraceOptions options);
  /// `scene` outlives the object. Throws UsageError as sync().
  TracedImages(const Scene& scene, TraceOptions options);

  /// Draws these layers, as TracedScene::sync(). Splats have a tree only while a mirror or glass is
  /// visible: primary rays need none. Throws UsageError if a layer has more splats than
  /// splatting::has_layer_for() allows. Calls the progress meanwhile, with 0.
  void sync(const std::vector<DocumentLayer>& layers);
  const TracedScene& scene() const { return traced_; }
  /// Replaces TraceOptions::progress.
  void report_to(std::function<void(double)> progress) { options_.progress = std::move(progress); }

  Image8 image(const FrameInput& input) override { return quantised(*exact_image(input)); }
  /// Alpha is the mean coverage of the samples: 1 at surfaces, otherwise the alpha of the splats.
  std::optional<ImageF> exact_image(const FrameInput& input) override;

  /// For images that are drawn in steps: jittered sample `i`, from 0, of each pixel, premultiplied
  /// over nothing, with coverage; row 0 is on top.
  std::vector<glm::dvec4> sample(const FrameInput& input, int i);
  /// The pixel of exact_image() with this sum of samples.
  glm::vec4 mean(const glm::dvec4& sum, int samples) const;

 private:
  struct TiledLayer {
    LayerId id;
    std::shared_ptr<const Primitives> primitives;
    Bounds bounds;
    std::unique_ptr<splatting::Layer> splats;  // null for soups
  };
  /// A layer of splats that is drawn.
  struct DrawnSplats {
    splatting::Layer* splats;
    const SplatProfile* profile;
    LayerPlace place;
  };
  /// One sample of each pixel: premultiplied colours and coverage.
  class Sample;
  const TiledLayer& tiled(const DocumentLayer& layer);
  std::vector<glm::dvec4> sample_at(const FrameInput& input, const glm::dvec2& offset, double from,
                                    double to);
  void run(std::size_t tasks, double from, double to, const std::function<void(std::size_t)>& body);
  /// Calls options_.progress.
  void report(double done);

  TraceOptions options_;
  ThreadPool pool_;
  TracedScene traced_;
  splatting::TileRenderer tiles_;
  std::vector<TiledLayer> tiled_;  // also of hidden layers
  std::vector<DrawnSplats> splats_;
  std::vector<LayerPlace> places_;  // of all visible layers
  double done_ = 0;                 // last reported
  bool is_cancelled_ = false;       // by options_.progress
};

}  // namespace tureen::tracing
