// What is looked at beside the colours, prepared when it is first asked for: inspections, and the
// comparison with a photograph.
#include "base/error.hpp"
#include "image/heat_map.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

void Application::inspect_when_needed() {
  if (state_.look.what == Inspection::color || !state_.stage || state_.inspector ||
      inspector_asked_)
    return;
  inspector_asked_ = true;
  const StageSource scene = state_.stage->source();
  const InspectorOptions options{.background = glm::vec4(scene.scene->info.background, 1.0f)};
  worker_.start({.kind = JobKind::inspection,
                 .what = "preparing to look into " + short_name(scene.path),
                 .work =
                     [this, scene, options](const Worker::Progress&) {
                       auto inspector = std::make_shared<Inspector>(window_.context(), scene.soup(),
                                                                    scene.scene->origin, options);
                       inspector->leave_context();
                       return Worker::Completion([this, inspector, of = scene.scene] {
                         if (!state_.stage || state_.stage->scene != of) return;
                         state_.inspector = std::make_unique<Inspector>(std::move(*inspector));
                         picture_is_current_ = false;
                       });
                     },
                 .failed =
                     [this](const std::string& reason) {
                       state_.look.what = Inspection::color;
                       inspector_asked_ = false;
                       state_.messages.error("It cannot be looked into", reason, state_.now);
                     }});
}

void Application::compare_when_needed() {
  Comparison& comparison = state_.comparison;
  const Photograph* photograph = state_.photograph();
  if (!photograph || comparison.show == Comparison::Show::off || !state_.stage) return;
  if (comparison.photograph != state_.recorded) {
    comparison.texture = PictureTexture(photograph->image);
    comparison.photograph = state_.recorded;
    comparison.forget();
  }
  if (comparison.result || comparison.asked) return;
  comparison.asked = true;
  Renderer& renderer = state_.stage->renderer;
  try {
    renderer.draw(photograph->camera);
  } catch (const DeviceLimitError& error) {
    comparison.show = Comparison::Show::off;
    picture_is_current_ = false;  // the window's went with its targets
    state_.messages.error("The photograph cannot be compared", error.reason(), state_.now);
    return;
  }
  const int ticket = comparison.ticket;
  auto drawn = std::make_shared<Image8>(renderer.read_color());
  picture_is_current_ = false;  // the window's comes next
  auto held = std::make_shared<Image8>(photograph->image);
  const glm::vec3 background = state_.stage->scene->info.background;
  worker_.start(
      {.kind = JobKind::comparison,
       .what = "comparing",
       .work =
           [this, drawn, held, background, ticket](const Worker::Progress&) {
             const ImageF ours = composited(to_float(*drawn), background);
             const ImageF theirs = composited(to_float(*held), background);
             const Metrics metrics = compare(ours, theirs, {.with_flip = false});
             auto map = std::make_shared<Image8>(difference(ours, theirs));
             return Worker::Completion([this, metrics, map, ticket] {
               if (state_.comparison.ticket != ticket) return;  // the view has moved on
               state_.comparison.result = Comparison::Result{metrics, PictureTexture(*map)};
             });
           },
       .failed =
           [this](const std::string& reason) {
             state_.messages.error("The photograph cannot be compared", reason, state_.now);
           }});
}

}  // namespace tureen::viewer
