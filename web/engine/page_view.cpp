#include "web/engine/page_view.hpp"

#include <memory>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"

namespace tureen::web {

namespace {

std::unique_ptr<PageView>& slot() {
  static std::unique_ptr<PageView> one;
  return one;
}

}  // namespace

void start_page_view() { slot() = std::make_unique<PageView>(); }

PageView& page_view() { return *slot(); }

PageView::PageView() : context_(gl::Context::external(nullptr, gl::Api::es)) {}

PageView::Stage PageView::make_stage(Renderer renderer, ShownScene scene) const {
  renderer.set_background(glm::vec4(background_, 1.0f));
  CameraControls controls(scene.subject);
  if (viewport_) controls.set_viewport(viewport_->x, viewport_->y);
  if (!scene.cameras.empty()) controls.set_first_view(scene.cameras.front());
  controls.reset();
  controls.arrive();
  return {{}, std::move(renderer), std::move(scene), controls};
}

void PageView::show_preview(Renderer renderer, ShownScene scene) {
  preview_.emplace(make_stage(std::move(renderer), std::move(scene)));
}

void PageView::show(Renderer renderer, ShownScene scene) {
  Stage stage = make_stage(std::move(renderer), std::move(scene));
  if (preview_) stage.controls = preview_->controls;
  drop_preview();
  drop_scene();
  stage_.emplace(std::move(stage));
}

void PageView::set_viewport(int width, int height) {
  viewport_ = {width, height};
  controls().set_viewport(width, height);
}

void PageView::drop_scene() {
  stage_.reset();
  read_scene_.reset();
}

void PageView::show(DebugView what, const FeatureChoice& features) {
  const bool shows_debug_view = what != DebugView::color;
  if (!stage_ && !shows_debug_view) return;
  if (!stage_) throw UsageError("there is no scene for a debug view");
  Stage& stage = *stage_;
  if (shows_debug_view) DebugViews(placed_soups(read_scene_.value().scene)).require(what, features);
  if (const bool had_debug_views = stage.debug_views.has_value();
      shows_debug_view != had_debug_views) {
    try {
      prepare_renderer(shows_debug_view);
    } catch (const DeviceLimitError&) {
      prepare_renderer(had_debug_views);
      throw;
    }
  }
  if (shows_debug_view) stage.debug_views->show(*stage.renderer, what, features);
  debug_view_ = what;
  features_ = features;
}

void PageView::prepare_renderer(bool for_debug_views) {
  const ReadScene& scene = read_scene_.value();
  Stage& stage = *stage_;
  stage.renderer.reset();
  stage.debug_views.reset();
  const DeviceLimits limits = device_limits(capabilities());
  const std::vector<PlacedSoup> layers = placed_soups(scene.scene);
  stage.renderer.emplace(context_, for_debug_views
                                       ? prepare_debug_views(layers, limits, scene.options)
                                       : prepare_scene(layers, limits, scene.options));
  if (for_debug_views) stage.debug_views.emplace(layers);
  stage.renderer->set_background(glm::vec4(background_, 1.0f));
}

Legend PageView::legend() const {
  return stage_ && stage_->debug_views ? stage_->debug_views->legend() : Legend{};
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

void PageView::draw(int width, int height, double seconds) {
  controls().advance(seconds, flight_);
  if (!shows_scene()) return clear_canvas(width, height);
  current()->renderer->draw({controls().camera(width, height)});
  current()->renderer->blit_to(0);
}

void PageView::clear_canvas(int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(background_.r, background_.g, background_.b, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

Image8 PageView::image(int width, int height) { return image(controls().camera(width, height)); }

Image8 PageView::image(const Camera& camera) {
  current()->renderer->draw({camera});
  return current()->renderer->read_color();
}

}  // namespace tureen::web
