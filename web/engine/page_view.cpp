#include "web/engine/page_view.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"

namespace tureen::web {

PageView::PageView(gl::Context context, SplatBlending blending, MakeSorter make_sorter)
    : context_(std::move(context)), blending_(blending), make_sorter_(std::move(make_sorter)) {}

void PageView::lose_device() {
  drop_preview();
  uploaded_.clear();
  if (!stage_) return;
  stage_->debug_views.reset();
  stage_->renderer.reset();
  stage_->layers.clear();
  debug_view_ = DebugView::color;
}

PageView::Stage PageView::make_stage(PreparedScene prepared, ShownScene scene,
                                     glm::vec3 background) const {
  Renderer renderer(context_, std::move(prepared));
  renderer.set_background(glm::vec4(background, 1.0f));
  CameraControls controls(scene.subject);
  if (viewport_) controls.set_viewport(viewport_->x, viewport_->y);
  controls.set_first_view(scene.first_view);
  controls.reset();
  controls.arrive();
  return {{}, std::move(renderer), std::move(scene), controls, {}};
}

void PageView::keep_view(Stage& stage) const {
  if (!preview_ || preview_->controls.goes_to_first_view()) return;
  stage.controls = preview_->controls;
  stage.controls.set_subject(stage.scene.subject);
}

void PageView::show_preview(PreparedScene prepared, ShownScene scene) {
  const glm::vec3 background = preview_ ? background_ : scene.background;
  Stage stage = make_stage(std::move(prepared), std::move(scene), background);
  keep_view(stage);
  if (!preview_) background_before_ = std::exchange(background_, background);
  preview_.emplace(std::move(stage));
}

void PageView::drop_preview() {
  if (!preview_) return;
  preview_.reset();
  background_ = background_before_;
}

void PageView::show(PreparedScene prepared, ShownScene scene) {
  drop_scene();
  std::vector<DocumentLayer> layers;
  for (std::size_t i = 0; i < prepared.layers.size(); ++i) {
    layers.push_back(described(prepared, i, document_.new_id()));
    layers[i].name = scene.names.at(i);
  }
  const Quality quality = prepared.plan.quality;
  const glm::vec3 background = preview_ ? background_ : scene.background;
  Stage stage = make_stage(std::move(prepared), std::move(scene), background);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    stage.layers.push_back(layers[i].id);
    facts_[stage.layers[i]].device_bytes = stage.renderer->layer_bytes(i);
  }
  keep_view(stage);
  document_.layers = std::move(layers);
  document_.quality = quality;
  document_.up = stage.controls.up();
  document_.background = background_ = background;
  preview_.reset();
  stage_.emplace(std::move(stage));
  stage_->renderer->sort_splats_with(make_sorter_());
}

void PageView::set_viewport(int width, int height) {
  viewport_ = {width, height};
  controls().set_viewport(width, height);
}

void PageView::drop_scene() {
  stage_.reset();
  path_ = {};
  read_scene_.reset();
  const LayerId next = document_.next_id;  // ids of layers that were shown are not used again
  document_ = {};
  document_.next_id = next;
  forget_steps();
  uploaded_.clear();
  facts_.clear();
  placements_.clear();
}

std::vector<PlacedLayer> PageView::read_layers() const {
  std::vector<PlacedLayer> layers;
  for (const LayerId id : stage_->layers)
    layers.push_back(placed_layer(*read_scene_.value().layers.at(id), layer_with(id)));
  return layers;
}

bool PageView::has_read_scene() const {
  return read_scene_ && std::all_of(document_.layers.begin(), document_.layers.end(),
                                    [&](const DocumentLayer& layer) {
                                      return read_scene_->layers.count(layer.id) > 0;
                                    });
}

void PageView::show(DebugView what, const FeatureChoice& features) {
  const bool shows_debug_view = what != DebugView::color;
  if (!stage_ && !shows_debug_view) return;
  if (!stage_ || !stage_->renderer) throw UsageError("there is no scene for a debug view");
  Stage& stage = *stage_;
  if (shows_debug_view) DebugViews(read_layers()).require(what, features);
  if (const bool had_debug_views = stage.debug_views.has_value();
      shows_debug_view != had_debug_views) {
    try {
      prepare_renderer(shows_debug_view);
    } catch (const Error&) {
      try {
        prepare_renderer(had_debug_views);
        if (had_debug_views) stage.debug_views->show(*stage.renderer, debug_view_, features_);
      } catch (const Error&) {
        drop_scene();
      }
      throw;
    }
  }
  if (shows_debug_view) stage.debug_views->show(*stage.renderer, what, features);
  debug_view_ = what;
  features_ = features;
}

void PageView::prepare_renderer(bool for_debug_views) {
  Stage& stage = *stage_;
  const std::vector<PlacedLayer> layers = read_layers();
  const RenderOptions& options = read_scene_->options;
  stage.renderer.reset();
  stage.debug_views.reset();
  const DeviceLimits limits = device_limits(capabilities());
  stage.renderer.emplace(context_, for_debug_views ? prepare_debug_views(layers, limits, options)
                                                   : prepare_scene(layers, limits, options));
  stage.renderer->sort_splats_with(make_sorter_());
  if (for_debug_views) stage.debug_views.emplace(layers);
  stage.renderer->set_background(glm::vec4(background_, 1.0f));
}

Legend PageView::legend() const {
  const Stage* shown = current();
  return shown && shown->debug_views ? shown->debug_views->legend() : Legend{};
}

bool PageView::moving() {
  return controls().moving() || flight_.direction != glm::dvec3(0.0) || !path_.empty();
}

void PageView::play(CameraPath path) {
  path_ = std::move(path);
  path_seconds_ = path_.begin();
}

void PageView::follow_path(int width, int height, double seconds) {
  path_seconds_ += seconds;
  controls().adopt(path_.at(path_seconds_, width, height));
  controls().arrive();
  if (!path_.is_loop() && path_seconds_ >= path_.begin() + path_.duration()) path_ = {};
}

bool PageView::focus(glm::dvec2 place, glm::dvec2 viewport) {
  if (!shows_scene()) return false;
  // A smaller image would suffice, but only this size has exactly the visible depth.
  Stage& stage = *current();
  const glm::ivec2 size(viewport);
  // Not every debug view draws depth.
  const bool lacks_depth = stage.debug_views && debug_view_ == DebugView::overdraw;
  if (lacks_depth) stage.debug_views->show(*stage.renderer, DebugView::color);
  stage.renderer->draw({stage.controls.camera(size.x, size.y)});
  const std::optional<glm::dvec3> point = stage.renderer->point_at(place);
  if (lacks_depth) stage.debug_views->show(*stage.renderer, debug_view_, features_);
  if (point) stage.controls.focus(*point);
  return point.has_value();
}

void PageView::paint(glm::vec3 background) {
  background_ = background;
  for (std::optional<Stage>* stage : {&stage_, &preview_})
    if (*stage && (*stage)->renderer)
      (*stage)->renderer->set_background(glm::vec4(background, 1.0f));
}

PageView::Next PageView::draw(int width, int height, double seconds) {
  controls().advance(seconds, flight_);
  if (!path_.empty()) follow_path(width, height, seconds);
  Next next = moving() ? Next::moving : Next::nothing;
  if (!shows_scene()) {
    clear_canvas(width, height);
    return next;
  }
  Renderer& renderer = *current()->renderer;
  const FrameInput input{controls().camera(width, height)};
  if (rests(input)) {
    if (renderer.can_refine()) renderer.refine();
  } else {
    renderer.draw(input, Renderer::SplatOrdering::earlier);
  }
  if (rests(input) && renderer.can_refine()) next = Next::refining;
  clear_after_presentation();
  renderer.blit_to(0);
  return next;
}

/// Whether the renderer's image is, or becomes, this input's image at rest. Not that of a preview:
/// its frames would slow down the load.
bool PageView::rests(const FrameInput& input) {
  const Renderer& renderer = *current()->renderer;
  return smooth_at_rest_ && !preview_ && !moving() && renderer.has_image_at_rest() &&
         renderer.shows(input);
}

/// Chromium clears a canvas that was presented late: at the next draw or clear, to any framebuffer,
/// or at the next read. Without one before the blit (tiles only upload), a read would clear the
/// image.
void PageView::clear_after_presentation() const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

void PageView::sort_in_frames() {
  if (stage_ && stage_->renderer) stage_->renderer->sort_splats_with(nullptr);
}

void PageView::clear_canvas(int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(background_.r, background_.g, background_.b, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

Image8 PageView::image(int width, int height) {
  // The sums of a larger image would take more than 576 MiB.
  constexpr int max_pixels_at_rest = 1 << 24;
  Renderer& renderer = *current()->renderer;
  const bool smooth = smooth_at_rest_ && width <= max_pixels_at_rest / height;
  const FrameInput input{controls().camera(width, height)};
  if (!smooth || !renderer.shows(input)) renderer.draw(input);
  while (smooth && renderer.can_refine()) renderer.refine();
  return renderer.read_color();
}

}  // namespace tureen::web
