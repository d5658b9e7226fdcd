// Changes the document, and makes the device, the view and the window's title follow it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace {

/// Whether two unit vectors are the same, but for rounding.
bool same_axis(const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) < 1e-9; }

std::vector<LayerId> ids_of(const std::vector<DocumentLayer>& layers) {
  std::vector<LayerId> ids;
  for (const DocumentLayer& layer : layers) ids.push_back(layer.id);
  return ids;
}

}  // namespace

void Application::carry_out(const Perform& request) {
  if (!state_.stage) return;
  state_.history.perform(state_.source.document, request.edit, request.gesture);
  follow_document();
}

void Application::carry_out(const GoToStep& request) {
  if (!state_.stage) return;
  state_.history.go_to(state_.source.document, request.position);
  follow_document();
}

void Application::carry_out(const Undo&) {
  const std::size_t position = state_.history.position();
  if (position == 0) return state_.note("There is nothing to undo.");
  state_.note("Undone: " + state_.history.steps()[position - 1].name);
  carry_out(GoToStep{position - 1});
}

void Application::carry_out(const Redo&) {
  const std::size_t position = state_.history.position();
  if (position == state_.history.steps().size()) return state_.note("There is nothing to redo.");
  state_.note("Redone: " + state_.history.steps()[position].name);
  carry_out(GoToStep{position + 1});
}

void Application::follow_document() {
  SceneSource& source = state_.source;
  update_subject(source);
  state_.controls.set_subject(source.subject);
  state_.controls.set_first_view(first_view_of(source));
  if (!same_axis(state_.controls.up(), source.document.up))
    state_.controls.set_up(source.document.up);
  if (why_not(state_.debug_view.what, source)) state_.debug_view.what = DebugView::color;
  sync_stage();
  const DrawingChoice choice = choice_of_document();
  if (quality_of(choice, *source.scene) != quality_of(state_.wanted, *source.scene) ||
      choice.plan.splat_profile != state_.wanted.plan.splat_profile)
    state_.ask(ChooseDrawing{choice});
  state_.comparison.forget();
  worker_.abandon(JobKind::comparison);
  if (source.paths() != shown_paths_) {
    merge_files(source);
    show_files_of_scene();
  }
  show_title();
}

void Application::follow_up_axis() {
  if (state_.stage && !same_axis(state_.controls.up(), state_.source.document.up))
    state_.edit(ChangeUp{state_.controls.up()});
}

void Application::show_title() {
  window_.set_title((state_.history.is_saved() ? "" : "*") + short_names(state_.source.paths()) +
                    " - Tureen");
}

void Application::sync_stage() {
  Stage& stage = *state_.stage;
  const std::vector<DocumentLayer> missing = sync(stage, state_.source.document);
  image_is_current_ = false;
  const std::vector<LayerId> ids = ids_of(missing);
  if (ids == uploading_) return;
  worker_.abandon(JobKind::layers);
  uploading_ = ids;
  if (missing.empty()) return;
  // The stage for debug views gives way to one for colours, which has all layers.
  const bool for_debug_views = state_.debug_view.what != DebugView::color;
  if (stage.debug_views && !for_debug_views) return uploading_.clear();
  const auto failed = [this, missing](const std::string& reason) {
    for (const DocumentLayer& layer : missing) state_.stage->refused.push_back({layer, 0, reason});
    state_.error(missing.front().name + " cannot be drawn", reason, Message::About::opening);
    uploading_.clear();
  };
  if (!stage.can_grow()) return prepare(JobKind::layers, for_debug_views, failed);
  const auto work = [this, missing, scene = state_.source.scene, choice = stage.choice,
                     shown = shown_](const Worker::Progress& progress) {
    auto addition = std::make_shared<StageAddition>(
        prepare_addition(missing, *scene, {window_.context(), choice, progress}));
    return Worker::Completion([this, addition, shown] {
      if (shown != shown_) return;  // the stage has changed, and uploads what it lacks
      uploading_.clear();
      report_refused(addition->refused);
      add_to(*state_.stage, std::move(*addition));
      frame_clock_.clear();
      sync_stage();
    });
  };
  worker_.start({.kind = JobKind::layers,
                 .what = "preparing " + missing.front().name,
                 .work = work,
                 .failed = failed});
}

void Application::prepare(JobKind kind, bool for_debug_views,
                          const std::function<void(const std::string&)>& failed) {
  // The device would refuse them for debug views, too.
  const SceneSource source = for_debug_views ? state_.drawn_source() : state_.source;
  const auto work = [this, source, for_debug_views, kind, opened = opened_,
                     choice = state_.wanted](const Worker::Progress& progress) {
    const auto make = for_debug_views ? prepare_debug_stage : prepare_stage;
    std::shared_ptr<Stage> stage = make(source, {window_.context(), choice, progress});
    return Worker::Completion([this, stage, for_debug_views, kind, opened] {
      if (opened != opened_) return;  // another scene was opened meanwhile
      if (kind == JobKind::drawing) preparing_drawing_ = false;
      if (for_debug_views) stage->refused = state_.stage->refused;
      show(std::move(*stage));
      follow_document();
    });
  };
  const bool names_debug_views = kind == JobKind::debug_view && for_debug_views;
  worker_.start({.kind = kind,
                 .what = (names_debug_views ? "preparing debug views of " : "preparing ") +
                         short_names(source.paths()),
                 .work = work,
                 .failed = failed});
}

void Application::show(Stage stage) {
  std::vector<RefusedLayer> refused = stage.refused;
  if (state_.stage)  // these were reported
    std::erase_if(refused, [&](const RefusedLayer& each) {
      const auto& known = state_.stage->refused;
      return std::any_of(known.begin(), known.end(), [&](const RefusedLayer& other) {
        return other.layer.id == each.layer.id;
      });
    });
  report_refused(refused);
  state_.stage = std::make_unique<Stage>(std::move(stage));
  state_.wanted = state_.stage->choice;
  ++shown_;
  uploading_.clear();
  worker_.abandon(JobKind::layers);
  worker_.abandon(JobKind::debug_view);
  preparing_debug_views_.reset();
  frame_clock_.clear();
}

DrawingChoice Application::choice_of_document() const {
  const SceneSource& source = state_.source;
  DrawingChoice choice = state_.wanted;
  Quality quality = source.document.quality;
  if (refused_quality_ == quality) quality.supersampling = 1;
  choice.quality.reset();
  if (quality != source.scene->quality) choice.quality = quality;
  choice.plan.splat_profile = source.document.profile;
  return choice;
}

void Application::keep_drawn_options() {
  const DrawingChoice& drawn = state_.wanted = state_.stage->choice;
  const Document& document = state_.source.document;
  const Quality quality = quality_of(drawn, *state_.source.scene);
  if (quality != document.quality && refused_quality_ != document.quality)
    state_.edit(ChangeQuality{quality});
  if (drawn.plan.splat_profile != document.profile)
    state_.edit(ChangeProfile{drawn.plan.splat_profile});
}

}  // namespace tureen::viewer
