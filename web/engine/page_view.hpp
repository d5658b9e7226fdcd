// The view of a canvas: a scene on the device, controls that move the view, and frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera_controls.hpp"
#include "image/image.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"
#include "scene/placed_layer.hpp"

namespace tureen::web {

/// A layer on the device, in the renderer's order.
struct ShownLayer {
  LayerPlace place;                       // with framed_bounds()
  std::size_t triangles = 0, splats = 0;  // one of them is 0
  std::size_t device_bytes = 0;           // of ordinary frames
};

/// The data of a scene that its renderer does not have.
struct ShownScene {
  Subject subject;
  std::vector<Camera> cameras;
  std::optional<Camera> first_view;  // first_view_of() (camera/capture.hpp)
};

class PageView {
 public:
  /// The canvas's context must be current, now and in all calls. `blending`: of all scenes.
  explicit PageView(SplatBlending blending);

  SplatBlending splat_blending() const { return blending_; }
  const gl::Capabilities& capabilities() const { return context_.capabilities(); }
  const gl::Context& context() const { return context_; }

  /// Shows a preview instead of the scene, until it is dropped or the next preview or scene
  /// arrives. That keeps the preview's view if it was moved.
  void show_preview(PreparedScene prepared, ShownScene scene);
  void drop_preview() { preview_.reset(); }
  void show(PreparedScene prepared, ShownScene scene);
  /// Frees the scene's memory on the device, but not the preview's.
  void drop_scene();
  bool shows_scene() const { return stage_ || preview_; }
  const Renderer& renderer() const { return *current()->renderer; }

  // Layers of the scene, not of a preview. The subject of the controls becomes the box around the
  // visible layers; the view stays. Without a scene or such a layer they throw UsageError.

  const std::vector<ShownLayer>& layers() const;
  /// Adds layers after the present ones. Only while the colours are shown; the scene must then be
  /// read again for debug views. Throws DeviceLimitError, then nothing has changed.
  void add_layers(PreparedScene prepared);
  void place_layer(std::size_t layer, const glm::dmat4& world_from_layer);
  void show_layer(std::size_t layer, bool visible);
  /// Not the only layer. Only while the colours are shown.
  void remove_layer(std::size_t layer);
  /// Moves a layer to another place in the order. Only while the colours are shown.
  void move_layer(std::size_t from, std::size_t to);

  /// The shown scene, read again in this instance: debug views need more data than its renderer
  /// has.
  struct ReadScene {
    std::vector<Scene> scenes;              // the sources of the page
    std::vector<const Primitives*> layers;  // the shown ones, in their order
    RenderOptions options;                  // of ordinary frames
  };
  void keep_read_scene(ReadScene scene) { read_scene_.emplace(std::move(scene)); }
  bool has_read_scene() const { return read_scene_.has_value(); }

  /// Selects a debug view, or the colours. Debug views need keep_read_scene() before. The device
  /// holds the scene once: if it must be prepared anew, the old renderer ends first. Throws
  /// UsageError with the sentence of why_not(), and DeviceLimitError; then the frames are as
  /// before.
  void show(DebugView what, const FeatureChoice& features);
  Legend legend() const;

  /// The controls of the preview or the scene; idle ones without both.
  CameraControls& controls() { return shows_scene() ? current()->controls : idle_; }
  /// Size in the unit of the pointer's deltas, for this scene and later ones.
  void set_viewport(int width, int height);
  /// Flies like this in each frame, until the next call.
  void fly(const Flight& flight) { flight_ = flight; }

  /// Moves the visible point at `place` to the centre. `place` and `viewport` have the same unit.
  /// Returns false for the background.
  bool focus(glm::dvec2 place, glm::dvec2 viewport);

  void set_background(glm::vec3 background);
  /// Requires a scene.
  const ShownScene& scene() const { return current()->scene; }

  /// The state after a frame; `moving` and `refining` need another frame.
  enum class Next { nothing, refining, moving };
  /// Advances the controls by `seconds`, draws, and copies the image to the canvas. `width`,
  /// `height`: size of the canvas's drawing buffer. While nothing changes, further calls add the
  /// frames of the image at rest (Renderer::refine()).
  ///
  /// Splats may be drawn in the order of an earlier view, until their sorter has the view's order
  /// (web/engine/splat_sorting.hpp) and draw() is called again.
  Next draw(int width, int height, double seconds);
  /// Whether there is an image at rest, in draw() and image(); by default there is.
  void smooth_at_rest(bool smooth) { smooth_at_rest_ = smooth; }
  /// Sorts splats in draw(), for pages whose worker cannot.
  void sort_in_frames();

  void clear_canvas(int width, int height) const;
  void clear_after_presentation() const;

  /// The current image, at any size that the device supports: the image at rest, unless it was
  /// switched off or has more than 16.8 million pixels.
  Image8 image(int width, int height);

 private:
  struct Stage {
    std::optional<DebugViews> debug_views;  // if the renderer was prepared for them
    std::optional<Renderer> renderer;       // always, except while another one is made
    ShownScene scene;
    CameraControls controls;
    std::vector<ShownLayer> layers;
  };
  bool moving();
  bool rests(const FrameInput& input);
  void prepare_renderer(bool for_debug_views);
  Stage make_stage(PreparedScene prepared, ShownScene scene) const;
  /// Keeps the view of the preview if it was moved. Otherwise the first view of `stage` stays: the
  /// preview may show only a part of the scene.
  void keep_view(Stage& stage) const;
  /// The scene, if it has this layer.
  Stage& stage_with(std::size_t layer);
  /// The same, but the colours must be shown.
  Stage& colors_with(std::size_t layer);
  static void follow_layers(Stage& stage);
  std::vector<PlacedLayer> read_layers() const;
  const Stage* current() const { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }
  Stage* current() { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }

  gl::Context context_;
  SplatBlending blending_;
  std::optional<Stage> stage_, preview_;
  std::optional<ReadScene> read_scene_;      // of stage_
  DebugView debug_view_ = DebugView::color;  // of stage_
  FeatureChoice features_;
  CameraControls idle_;
  std::optional<glm::ivec2> viewport_;
  Flight flight_;
  glm::vec3 background_{0.0f};
  bool smooth_at_rest_ = true;
};

/// The view of this instance, for all commands.
void start_page_view(SplatBlending blending);
PageView& page_view();

}  // namespace tureen::web
