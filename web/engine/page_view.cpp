#include "web/engine/page_view.hpp"

#include <memory>

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
  return {std::move(renderer), std::move(scene), controls};
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
  debug_renderer_.reset();
  debug_view_ = DebugView::color;
}

void PageView::show(DebugView what, const FeatureChoice& features) {
  if (what != DebugView::color) debug_renderer_.value().show(what, features);
  debug_view_ = what;
}

void PageView::set_debug_view_renderer(DebugViewRenderer debug_renderer) {
  debug_renderer_.emplace(std::move(debug_renderer));
  debug_renderer_->set_background(glm::vec4(background_, 1.0f));
}

Legend PageView::legend() const {
  return shows_debug_view() ? debug_renderer_->legend() : Legend{};
}

bool PageView::moving() { return controls().moving() || flight_.direction != glm::dvec3(0.0); }

bool PageView::focus(glm::dvec2 place, glm::dvec2 viewport) {
  if (!shows_scene()) return false;
  // A smaller image would suffice, but only this size has exactly the visible depth.
  Stage& stage = *current();
  const glm::ivec2 size(viewport);
  stage.renderer.draw(stage.controls.camera(size.x, size.y));
  const std::optional<glm::dvec3> point = stage.renderer.point_at(place);
  if (point) stage.controls.focus(*point);
  return point.has_value();
}

void PageView::set_background(glm::vec3 background) {
  background_ = background;
  for (std::optional<Stage>* stage : {&stage_, &preview_})
    if (*stage) (*stage)->renderer.set_background(glm::vec4(background, 1.0f));
  if (debug_renderer_) debug_renderer_->set_background(glm::vec4(background, 1.0f));
}

void PageView::draw(int width, int height, double seconds) {
  controls().advance(seconds, flight_);
  if (!shows_scene()) return clear_canvas(width, height);
  draw_frame(controls().camera(width, height));
  if (shows_debug_view())
    debug_renderer_->blit_to(0);
  else
    current()->renderer.blit_to(0);
}

void PageView::draw_frame(const Camera& camera) {
  if (shows_debug_view())
    debug_renderer_->draw(camera);
  else
    current()->renderer.draw(camera);
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
  draw_frame(camera);
  return shows_debug_view() ? debug_renderer_->read_color() : current()->renderer.read_color();
}

}  // namespace tureen::web
