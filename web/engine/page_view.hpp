// What a canvas shows: a scene on the device, controls that move the view, and frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera_controls.hpp"
#include "image/image.hpp"
#include "runtime/debug_views/debug_view_renderer.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"

namespace tureen::web {

/// What is known of a scene beside what its renderer has.
struct ShownScene {
  Subject subject;
  std::vector<Camera> cameras;
};

class PageView {
 public:
  /// The canvas's context must be current, now and in all calls.
  PageView();

  const gl::Capabilities& capabilities() const { return context_.capabilities(); }
  const gl::Context& context() const { return context_; }

  /// A preview is shown over the scene until it is dropped, or until the next scene, which goes on
  /// with the preview's view.
  void show_preview(Renderer renderer, ShownScene scene);
  void drop_preview() { preview_.reset(); }
  void show(Renderer renderer, ShownScene scene);
  /// Gives back the device's memory of the scene, but not of the preview.
  void drop_scene();
  bool shows_scene() const { return stage_ || preview_; }
  const Renderer& renderer() const { return current()->renderer; }

  /// Throws UsageError with why_not()'s sentence.
  void look(DebugView what, const FeatureChoice& features);
  bool has_debug_view_renderer() const { return debug_renderer_.has_value(); }
  void set_debug_view_renderer(DebugViewRenderer debug_renderer);
  Legend legend() const;

  /// Of what is shown; where nothing is, of nothing in particular.
  CameraControls& controls() { return shows_scene() ? current()->controls : idle_; }
  /// In the unit of the pointer's deltas, for this scene and those that come.
  void set_viewport(int width, int height);
  /// Flies on so, each frame, until it is told otherwise.
  void fly(const Flight& flight) { flight_ = flight; }
  bool moving();

  /// Brings what is shown there, in the unit of the viewport, to the centre. False where that is
  /// the background.
  bool focus(glm::dvec2 place, glm::dvec2 viewport);

  void set_background(glm::vec3 background);
  /// Asserts that there is a scene.
  const ShownScene& scene() const { return current()->scene; }

  /// Lets time pass, draws, and copies the image to the canvas, whose drawing buffer has this
  /// size.
  void draw(int width, int height, double seconds);

  void clear_canvas(int width, int height) const;

  /// What is shown, at any size that the device draws.
  Image8 image(int width, int height);
  Image8 image(const Camera& camera);

 private:
  struct Stage {
    Renderer renderer;
    ShownScene scene;
    CameraControls controls;
  };
  Stage make_stage(Renderer renderer, ShownScene scene) const;
  const Stage* current() const { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }
  Stage* current() { return preview_ ? &*preview_ : stage_ ? &*stage_ : nullptr; }
  bool looks_into() const { return look_ != DebugView::color && !preview_; }
  void draw_frame(const Camera& camera);

  gl::Context context_;
  std::optional<Stage> stage_, preview_;
  std::optional<DebugViewRenderer> debug_renderer_;  // of the stage
  DebugView look_ = DebugView::color;
  CameraControls idle_;
  std::optional<glm::ivec2> viewport_;
  Flight flight_;
  glm::vec3 background_{0.0f};
};

/// This instance's one: commands are about it.
void start_page_view();
PageView& page_view();

}  // namespace tureen::web
