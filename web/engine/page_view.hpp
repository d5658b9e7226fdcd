// The view of a canvas: a document on the device, controls that move the view, and frames.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera_controls.hpp"
#include "camera/camera_path.hpp"
#include "image/image.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"
#include "runtime/splats/splat_sorter.hpp"
#include "scene/document/history.hpp"
#include "scene/placed_layer.hpp"
#include "scene/similarity.hpp"

namespace tureen::web {

/// What is known about a layer whose primitives only the device has.
struct LayerFacts {
  std::size_t triangles = 0, splats = 0;  // one of them is 0
  std::size_t device_bytes = 0;           // of ordinary frames
};

/// The data of a scene that its renderer does not have.
struct ShownScene {
  Subject subject;
  std::vector<Camera> cameras = {};
  std::optional<Camera> first_view = {};  // first_view_of() (camera/capture.hpp)
  glm::vec3 background{0.0f};
  std::vector<std::string> names = {};  // of its layers
};

class PageView {
 public:
  using MakeSorter = std::function<std::unique_ptr<SplatSorter>()>;
  /// The canvas's context; it must be current, now and in all calls. `blending`: of all scenes.
  PageView(gl::Context context, SplatBlending blending, MakeSorter make_sorter);

  SplatBlending splat_blending() const { return blending_; }
  const gl::Capabilities& capabilities() const { return context_.capabilities(); }
  const gl::Context& context() const { return context_; }

  /// The context was lost, and everything on the device with it. Document, history and view stay.
  void lose_device();
  /// With a new context: missing() layers must be uploaded again.
  void regain_device(gl::Context context) { context_ = std::move(context); }

  /// Shows a preview instead of the scene, until it is dropped or the next preview or scene
  /// arrives. That keeps the preview's view and background if they were changed.
  void show_preview(PreparedScene prepared, ShownScene scene);
  void drop_preview();
  /// Begins a new document and a new history.
  void show(PreparedScene prepared, ShownScene scene);
  /// Forgets the document, and frees its memory on the device, but not the preview's.
  void drop_scene();
  /// Whether a frame shows a scene or a preview.
  bool shows_scene() const { return current() && current()->renderer; }
  /// That of the scene; null without one, and after the device was lost.
  const Renderer* renderer() const {
    return stage_ && stage_->renderer ? &*stage_->renderer : nullptr;
  }

  // The document, without primitives: that of the scene, not of a preview. Functions with a
  // LayerId throw UsageError if it lacks the layer. After each change, the device follows, and the
  // subject of the controls becomes the box around the visible layers; the view stays.

  const Document& document() const { return document_; }
  const History& history() const { return history_; }
  const LayerFacts& facts(LayerId layer) const { return facts_.at(layer); }
  /// The numbers of its last place_layer() if they still give its place.
  Similarity placement(const DocumentLayer& layer) const;

  /// `visible`: default: as it is. Both are one step.
  void place_layer(LayerId layer, const Similarity& placement, std::optional<bool> visible = {});
  void place_layer(LayerId layer, const glm::dmat4& world_from_layer,
                   std::optional<bool> visible = {});
  void show_layer(LayerId layer, bool visible);
  void move_layer(LayerId layer, std::size_t to);
  /// Not the only layer.
  void remove_layer(LayerId layer);
  /// The up axis of view and document.
  void set_up(const glm::dvec3& axis);
  /// The first view. Its up axis becomes the document's, too.
  void home();
  /// Of document, preview or empty canvas.
  void set_background(glm::vec3 background);
  glm::vec3 background() const { return background_; }
  /// Changes of the same thing, while this is true, are one step.
  void hold(bool held) { gesture_ = held ? ++last_gesture_ : 0; }

  /// Undoes or redoes steps up to this position. If the device lacks layers of that document,
  /// changes nothing and returns them: call upload_again() for each, then go_to() again.
  std::vector<LayerId> go_to(std::size_t position);
  void forget_steps() { history_ = History(); }
  /// The layers of the document that the device lacks.
  std::vector<LayerId> missing() const { return missing(document_); }

  // Uploads: one layer each, only while the colours are shown. Until their step, the layers are
  // hidden and not in the document. They throw DeviceLimitError, then nothing has changed.

  /// A new layer.
  void upload(PreparedScene prepared, const std::string& name);
  /// A layer that the document has or had.
  void upload_again(PreparedScene prepared, LayerId layer);
  /// Adds the new layers to the document. `is_step`: otherwise the scene is still being opened.
  /// Returns their ids.
  std::vector<LayerId> add_uploaded(bool is_step);
  /// Frees what was uploaded and has no step.
  void drop_uploaded();
  /// Removes layers from the document that cannot be read again. This is no step. At least one
  /// stays.
  void give_up(const std::vector<LayerId>& layers);

  /// The shown scene, read again in this instance: debug views need more data than its renderer
  /// has.
  struct ReadScene {
    std::vector<Scene> scenes;  // the sources of the page
    std::map<LayerId, const Primitives*> layers;
    RenderOptions options;  // of ordinary frames
  };
  void keep_read_scene(ReadScene scene) { read_scene_.emplace(std::move(scene)); }
  /// Whether it has all layers of the document.
  bool has_read_scene() const;

  /// Selects a debug view, or the colours. Debug views need keep_read_scene() before. The device
  /// holds the scene once: if it must be prepared anew, the old renderer ends first. Throws
  /// UsageError with the sentence of why_not(), and DeviceLimitError; then the frames are as
  /// before.
  void show(DebugView what, const FeatureChoice& features);
  Legend legend() const;

  /// The controls of the preview or the scene; idle ones without both.
  CameraControls& controls() { return current() ? current()->controls : idle_; }
  /// Size in the unit of the pointer's deltas, for this scene and later ones.
  void set_viewport(int width, int height);
  /// Flies like this in each frame, until the next call.
  void fly(const Flight& flight) { flight_ = flight; }

  /// Moves the view along a path, from its beginning on, in each frame; an empty one ends this, as
  /// does the end of a path that is no loop.
  void play(CameraPath path);

  /// Moves the visible point at `place` to the centre. `place` and `viewport` have the same unit.
  /// Returns false for the background.
  bool focus(glm::dvec2 place, glm::dvec2 viewport);

  /// Requires shows_scene().
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
    /// Always, except while another one is made, and after the device was lost.
    std::optional<Renderer> renderer;
    ShownScene scene;
    CameraControls controls;
    std::vector<LayerId> layers;  // on the device, in the renderer's order; empty in a preview
  };
  bool moving();
  void follow_path(int width, int height, double seconds);
  bool rests(const FrameInput& input);
  void prepare_renderer(bool for_debug_views);
  Stage make_stage(PreparedScene prepared, ShownScene scene, glm::vec3 background) const;
  /// Keeps the view of the preview if it was moved. Otherwise the first view of `stage` stays: the
  /// preview may show only a part of the scene.
  void keep_view(Stage& stage) const;
  const DocumentLayer& layer_with(LayerId id) const;
  std::vector<LayerId> missing(const Document& document) const;
  DocumentLayer described(const PreparedScene& prepared, std::size_t layer, LayerId id);
  void upload_layer(PreparedScene prepared, LayerId layer);
  void perform(const Edit& edit);
  void follow(const Document& before);
  void follow_up_axis();
  void sync();
  void follow_layers();
  void paint(glm::vec3 background);
  std::vector<PlacedLayer> read_layers() const;
  const Stage* current() const { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }
  Stage* current() { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }

  gl::Context context_;
  SplatBlending blending_;
  MakeSorter make_sorter_;
  Document document_;
  History history_;
  std::uint64_t gesture_ = 0, last_gesture_ = 0;
  std::map<LayerId, LayerFacts> facts_;  // also of removed layers
  std::map<LayerId, Similarity> placements_;
  std::vector<DocumentLayer> uploaded_;  // without their step
  std::optional<Stage> stage_, preview_;
  std::optional<ReadScene> read_scene_;      // of stage_
  DebugView debug_view_ = DebugView::color;  // of stage_
  FeatureChoice features_;
  CameraControls idle_;
  std::optional<glm::ivec2> viewport_;
  Flight flight_;
  CameraPath path_;  // that is played; empty: none
  double path_seconds_ = 0;
  glm::vec3 background_{0.0f}, background_before_{0.0f};  // before a preview
  bool smooth_at_rest_ = true;
};

}  // namespace tureen::web
