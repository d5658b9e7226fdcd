#include "web/engine/page_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"
#include "web/engine/splat_sorting.hpp"

namespace tureen::web {

namespace {

std::unique_ptr<PageView>& slot() {
  static std::unique_ptr<PageView> one;
  return one;
}

std::vector<ShownLayer> layers_of(const PreparedScene& prepared) {
  std::vector<ShownLayer> layers;
  for (std::size_t i = 0; i < prepared.layers.size(); ++i) {
    const PreparedLayer& layer = prepared.layers[i];
    const LayerPlan& plan = *prepared.plan.layers[i];
    const auto* splats = std::get_if<SplatPlan>(&plan);
    layers.push_back({.place = {layer.framed, layer.place.world_from_layer, layer.place.visible},
                      .triangles = splats ? 0 : std::get<SoupPlan>(plan).soup_faces,
                      .splats = splats ? splats->splats : 0});
  }
  return layers;
}

/// Notes the memory of the layers of an ordinary frame's renderer.
void weigh(std::vector<ShownLayer>& layers, const Renderer& renderer) {
  for (std::size_t i = 0; i < layers.size(); ++i) layers[i].device_bytes = renderer.layer_bytes(i);
}

}  // namespace

void start_page_view(SplatBlending blending) { slot() = std::make_unique<PageView>(blending); }

PageView& page_view() { return *slot(); }

PageView::PageView(SplatBlending blending)
    : context_(gl::Context::external(nullptr, gl::Api::es)), blending_(blending) {}

PageView::Stage PageView::make_stage(PreparedScene prepared, ShownScene scene) const {
  std::vector<ShownLayer> layers = layers_of(prepared);
  Renderer renderer(context_, std::move(prepared));
  weigh(layers, renderer);
  renderer.set_background(glm::vec4(background_, 1.0f));
  CameraControls controls(scene.subject);
  if (viewport_) controls.set_viewport(viewport_->x, viewport_->y);
  controls.set_first_view(scene.first_view);
  controls.reset();
  controls.arrive();
  return {{}, std::move(renderer), std::move(scene), controls, std::move(layers)};
}

void PageView::keep_view(Stage& stage) const {
  if (!preview_ || preview_->controls.goes_to_first_view()) return;
  stage.controls = preview_->controls;
  stage.controls.set_subject(stage.scene.subject);
}

void PageView::show_preview(PreparedScene prepared, ShownScene scene) {
  Stage stage = make_stage(std::move(prepared), std::move(scene));
  keep_view(stage);
  preview_.emplace(std::move(stage));
}

void PageView::show(PreparedScene prepared, ShownScene scene) {
  Stage stage = make_stage(std::move(prepared), std::move(scene));
  keep_view(stage);
  drop_preview();
  drop_scene();
  stage_.emplace(std::move(stage));
  stage_->renderer->sort_splats_with(make_page_sorter());
}

void PageView::set_viewport(int width, int height) {
  viewport_ = {width, height};
  controls().set_viewport(width, height);
}

void PageView::drop_scene() {
  stage_.reset();
  read_scene_.reset();
}

const std::vector<ShownLayer>& PageView::layers() const {
  static const std::vector<ShownLayer> none;
  return stage_ ? stage_->layers : none;
}

PageView::Stage& PageView::stage_with(std::size_t layer) {
  if (!stage_ || layer >= stage_->layers.size())
    throw UsageError("there is no layer " + std::to_string(layer) + ", counted from 0");
  return *stage_;
}

PageView::Stage& PageView::colors_with(std::size_t layer) {
  Stage& stage = stage_with(layer);
  if (stage.debug_views) throw UsageError("a debug view is shown: show the colours first");
  return stage;
}

/// Gives the controls the box around the visible layers; around all if none is visible.
void PageView::follow_layers(Stage& stage) {
  const bool any = std::any_of(stage.layers.begin(), stage.layers.end(),
                               [](const ShownLayer& layer) { return layer.place.visible; });
  std::vector<LayerPlace> boxes;
  for (const ShownLayer& layer : stage.layers)
    if (layer.place.visible || !any) boxes.push_back(layer.place);
  stage.scene.subject = subject_of(boxes, stage.scene.subject.up, stage.scene.cameras);
  stage.controls.set_subject(stage.scene.subject);
}

void PageView::add_layers(PreparedScene prepared) {
  Stage& stage = colors_with(0);
  if (stage.layers.size() + prepared.layers.size() > max_layers)
    throw UsageError("at most " + std::to_string(max_layers) +
                     " layers can be drawn together: remove layers first");
  if (prepared.plan.reversed_depth != stage.renderer->plan().reversed_depth)
    throw UsageError("the layer was prepared for another device");
  std::vector<ShownLayer> added = layers_of(prepared);
  stage.renderer->add_layers(std::move(prepared));
  read_scene_.reset();
  stage.layers.insert(stage.layers.end(), added.begin(), added.end());
  weigh(stage.layers, *stage.renderer);
  follow_layers(stage);
}

void PageView::place_layer(std::size_t layer, const glm::dmat4& world_from_layer) {
  Stage& stage = stage_with(layer);
  if (const auto reason = defect(Layer{.world_from_layer = world_from_layer}))
    throw UsageError("the layer cannot be placed: " + *reason);
  stage.renderer->place_layer(layer, world_from_layer);
  stage.layers[layer].place.world_from_layer = world_from_layer;
  follow_layers(stage);
}

void PageView::show_layer(std::size_t layer, bool visible) {
  Stage& stage = stage_with(layer);
  stage.renderer->show_layer(layer, visible);
  stage.layers[layer].place.visible = visible;
  follow_layers(stage);
}

void PageView::remove_layer(std::size_t layer) {
  Stage& stage = colors_with(layer);
  if (stage.layers.size() == 1)
    throw UsageError("the only layer cannot be removed: remove the scene");
  const auto at = static_cast<std::ptrdiff_t>(layer);
  stage.renderer->remove_layer(layer);
  stage.layers.erase(stage.layers.begin() + at);
  if (read_scene_) read_scene_->layers.erase(read_scene_->layers.begin() + at);
  follow_layers(stage);
}

void PageView::move_layer(std::size_t from, std::size_t to) {
  colors_with(to);
  Stage& stage = colors_with(from);
  for (std::size_t at = from; at != to;) {
    const std::size_t next = from < to ? at + 1 : at - 1;
    stage.renderer->swap_layers(at, next);
    std::swap(stage.layers[at], stage.layers[next]);
    if (read_scene_) std::swap(read_scene_->layers[at], read_scene_->layers[next]);
    at = next;
  }
}

std::vector<PlacedLayer> PageView::read_layers() const {
  const ReadScene& read = read_scene_.value();
  std::vector<PlacedLayer> layers;
  for (std::size_t i = 0; i < read.layers.size(); ++i)
    layers.push_back(placed_layer(*read.layers[i], stage_->layers[i].place));
  return layers;
}

void PageView::show(DebugView what, const FeatureChoice& features) {
  const bool shows_debug_view = what != DebugView::color;
  if (!stage_ && !shows_debug_view) return;
  if (!stage_) throw UsageError("there is no scene for a debug view");
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
  stage.renderer->sort_splats_with(make_page_sorter());
  if (for_debug_views) stage.debug_views.emplace(layers);
  stage.renderer->set_background(glm::vec4(background_, 1.0f));
}

Legend PageView::legend() const {
  const Stage* shown = current();
  return shown && shown->debug_views ? shown->debug_views->legend() : Legend{};
}

bool PageView::moving() { return controls().moving() || flight_.direction != glm::dvec3(0.0); }

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

void PageView::set_background(glm::vec3 background) {
  background_ = background;
  for (std::optional<Stage>* stage : {&stage_, &preview_})
    if (*stage) (*stage)->renderer->set_background(glm::vec4(background, 1.0f));
}

PageView::Next PageView::draw(int width, int height, double seconds) {
  controls().advance(seconds, flight_);
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
  if (stage_) stage_->renderer->sort_splats_with(nullptr);
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
