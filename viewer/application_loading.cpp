// Reads scenes in the background and shows them.
#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Fraction of the progress bar for reading; the rest is for preparation.
constexpr double reading_share = 0.9;

}  // namespace

void Application::load(const Loading& loading) {
  loading_ = loading;
  std::shared_ptr<StageSource> before;  // the job must not use the stage, which changes
  if (loading.relation != Relation::other)
    before = std::make_shared<StageSource>(state_.stage->source());
  // A drawing job of the same scene stays: it is finished before the new layers are read.
  if (loading.relation != Relation::grown) {
    worker_.abandon(JobKind::drawing);
    preparing_drawing_ = false;
  }
  const DrawingChoice choice = state_.stage ? state_.wanted : options_.drawing;
  const std::vector<fs::path> named =
      loading.relation == Relation::changed ? before->paths() : loading.paths;
  auto files = std::make_shared<Reading>(Reading{.current = named.front(), .failures = {}});
  const auto work = [this, loading, before, choice, files](const Worker::Progress& progress) {
    return load_in_background(loading, before, {window_.context(), choice, progress}, files);
  };
  const auto failed = [this, files, relation = loading.relation](const std::string& reason) {
    files->failures.push_back({files->current, reason});
    end_loading(*files, relation);
  };
  worker_.start({.kind = JobKind::scene,
                 .what = "reading " + short_names(named),
                 .work = work,
                 .failed = failed});
}

void Application::end_loading(const Reading& files, Relation relation) {
  loading_.reset();
  const bool in_part = shows_preview_of(files);
  const auto about =
      in_part || relation == Relation::changed ? Message::About::scene : Message::About::opening;
  for (const Reading::Failure& each : files.failures)
    state_.error(short_name(each.path) + (in_part ? " is shown only in part" : " cannot be shown"),
                 each.reason, about);
}

/// Runs in the worker's thread; its result runs in the main thread.
Worker::Completion Application::load_in_background(const Loading& loading,
                                                   const std::shared_ptr<StageSource>& before,
                                                   const StageRequest& request,
                                                   const std::shared_ptr<Reading>& files) {
  const ReadRequest reading{
      .paths = loading.paths,
      .progress = [&](double done) { request.progress(reading_share * done); },
      .begins = [&](const fs::path& path) { files->current = path; },
      .unreadable =
          [&](const fs::path& path, const std::string& reason) {
            files->failures.push_back({path, reason});
          },
      .max_splats = options_.max_splats};
  const StageRequest preparing{request.context, request.choice, [&](double done) {
                                 request.progress(reading_share + (1 - reading_share) * done);
                               }};
  if (loading.relation == Relation::grown) {
    const StageSource source = read_more(*before, reading);
    auto addition =
        std::make_shared<StageAddition>(prepare_addition(source, before->layers.size(), preparing));
    return [this, addition, files] {
      state_.messages.dismiss_opening();
      end_loading(*files, Relation::grown);
      add(addition);
    };
  }
  const bool again = loading.relation == Relation::changed;
  if (!again && loading.paths.size() == 1) post_previews(loading.paths.front(), request, files);
  std::shared_ptr<Stage> stage =
      prepare_fitting_stage(again ? read_again(*before, reading) : read_source(reading), preparing);
  return [this, stage = std::move(stage), relation = loading.relation,
          is_alone = loading.paths.empty(), files] {
    // A changed file is not another one, unless it was read together with further files.
    if (relation == Relation::changed && is_alone)
      state_.messages.dismiss_scene();
    else
      state_.messages.dismiss_opening();
    end_loading(*files, relation);
    show_read(std::move(*stage), relation, *files);
    preview_.reset();
  };
}

/// Runs in the worker's thread.
void Application::post_previews(const fs::path& path, const StageRequest& request,
                                const std::shared_ptr<const Reading>& reading) {
  const auto check = [&](double) { request.progress(0); };  // ends an abandoned job
  std::uint64_t shown = 0;
  while (const auto preview = read_source_preview(path, shown, [&] { check(0); })) {
    shown = preview->bytes;
    const StageLayer& layer = preview->source.layers.front();
    if (!layer.soup() && options_.max_splats && layer.primitive_count() > *options_.max_splats)
      return;
    std::shared_ptr<Stage> stage;
    try {
      stage = prepare_stage(preview->source, {request.context, request.choice, check});
    } catch (const Error&) {
      return;  // if the whole scene is refused too, its preparation reports the reason
    }
    worker_.post([this, stage, reading] {
      show_read(std::move(*stage), Relation::other, *reading);
      preview_ = Preview{reading, state_.stage->scene};
    });
  }
}

bool Application::shows_preview() const {
  return preview_ && state_.stage && state_.stage->scene == preview_->scene;
}

bool Application::shows_preview_of(const Reading& reading) const {
  return shows_preview() && preview_->reading.get() == &reading;
}

/// Keeps what the user changed on a preview of the same file. Without changes, the scene is shown
/// as if there had been no preview.
void Application::show_read(Stage stage, Relation relation, const Reading& reading) {
  std::optional<DrawingChoice> chosen;
  if (shows_preview_of(reading)) {
    if (!state_.controls.goes_to_first_view() || !state_.stage->is_as_read())
      relation = Relation::changed;
    if (preparing_drawing_) chosen = state_.wanted;
    preview_->scene = stage.scene;
  }
  show(std::move(stage), relation);
  if (chosen) state_.ask(ChooseDrawing{*chosen});
}

void Application::add(const std::shared_ptr<StageAddition>& addition) {
  report_refused(addition->refused);
  if (addition->layers.empty()) return;
  Stage& stage = *state_.stage;
  if (!stage.can_grow()) {  // debug views, the baseline
    StageSource source = addition->source;
    // Without the layers that were refused.
    std::erase_if(source.layers, [&](const StageLayer& layer) {
      return std::any_of(addition->refused.begin(), addition->refused.end(),
                         [&](const RefusedLayer& refused) { return refused.name == layer.name; });
    });
    prepare_grown(source);
    return;
  }
  const std::vector<std::string> known = named_notes(stage);
  add_to(stage, std::move(*addition));
  for (const std::string& note : window_notes(stage.scene->info))
    if (std::find(known.begin(), known.end(), note) == known.end()) state_.note(note);
  state_.layer_editing.selected = stage.layers.size() - 1;
  // Jobs for the scene before would show it without the new layers.
  worker_.abandon(JobKind::debug_view);
  preparing_debug_views_.reset();
  if (preparing_drawing_) state_.ask(ChooseDrawing{state_.wanted});
  state_.debug_view.features = {};
  frame_clock_.clear();
  after_change_of_layers();
  show_files_of_scene();
}

/// Prepares all layers anew, where the renderer cannot take further ones.
void Application::prepare_grown(const StageSource& source) {
  // Colours, if a layer lacks the debug view.
  if (why_not(state_.debug_view.what, source)) state_.debug_view.what = DebugView::color;
  loading_ = Loading{.relation = Relation::grown, .paths = {}};
  for (std::size_t i = state_.stage->files.size(); i < source.files.size(); ++i)
    loading_->paths.push_back(source.files[i].path);
  const auto prepared = [this](Stage& stage) {
    loading_.reset();
    show(std::move(stage), Relation::grown);
  };
  const auto failed = [this,
                       name = short_name(source.files.back().path)](const std::string& reason) {
    loading_.reset();
    state_.error(name + " cannot be shown", reason, Message::About::opening);
  };
  prepare(JobKind::scene, source, state_.debug_view.what != DebugView::color, prepared, failed);
}

void Application::prepare(JobKind kind, const StageSource& source, bool for_debug_views,
                          const std::function<void(Stage&)>& prepared,
                          const std::function<void(const std::string&)>& failed) {
  const auto make = for_debug_views ? prepare_debug_stage : prepare_stage;
  const auto work = [this, source, make, prepared,
                     choice = state_.wanted](const Worker::Progress& progress) {
    std::shared_ptr<Stage> stage = make(source, {window_.context(), choice, progress});
    return Worker::Completion([prepared, stage] { prepared(*stage); });
  };
  const bool names_debug_views = kind == JobKind::debug_view && for_debug_views;
  worker_.start({.kind = kind,
                 .what = (names_debug_views ? "preparing debug views of " : "preparing ") +
                         short_names(source.paths()),
                 .work = work,
                 .failed = failed});
}

void Application::report_refused(const std::vector<RefusedLayer>& layers) {
  for (const RefusedLayer& layer : layers)
    state_.error("The layer " + layer.name + " does not fit the device's memory", describe(layer),
                 Message::About::scene);
}

/// After a change of the files.
void Application::show_files_of_scene() {
  const std::vector<fs::path> paths = state_.stage->paths();
  watches_.clear();
  for (const SceneFile& file : state_.stage->files)
    if (std::find(paths.begin(), paths.end(), file.path) != paths.end())
      watches_.push_back(file.watch);
  // The first file comes first in the list of recent files.
  for (auto path = paths.rbegin(); path != paths.rend(); ++path) remember(state_.settings, *path);
  window_.set_title(short_names(paths) + " - Tureen");
}

void Application::show(Stage stage, Relation relation) {
  const bool same_scene = state_.stage && state_.stage->scene == stage.scene;
  const bool keep_view = state_.stage && relation != Relation::other;
  if (keep_view) {
    // The user may have changed layers meanwhile.
    StageSource now = stage.source();
    keep_changes(now, *state_.stage);
    arrange_layers(stage, std::move(now.layers));
  }
  const bool replaces = state_.stage && !keep_view;
  state_.stage = std::make_unique<Stage>(std::move(stage));
  state_.wanted = state_.stage->choice;
  image_is_current_ = false;
  worker_.abandon(JobKind::debug_view);
  worker_.abandon(JobKind::comparison);
  preparing_debug_views_.reset();
  state_.comparison.forget();
  frame_clock_.clear();
  if (same_scene) return;  // only the method of drawing changed
  if (replaces && state_.photographs && !std::exchange(state_.photographs->stay_is_noted, true))
    state_.note("The photographs of " + short_name(state_.photographs->path) +
                " stay open. Close them in Photographs.");
  preparing_drawing_ = false;
  report_refused(state_.stage->refused);
  state_.debug_view.features = {};
  if (why_not(state_.debug_view.what, *state_.stage)) state_.debug_view.what = DebugView::color;
  if (!state_.photographs && state_.recorded >= int(state_.stage->scene->cameras.size()))
    state_.recorded = -1;
  const Subject& subject = state_.stage->subject;
  if (keep_view) {
    state_.controls.set_subject(subject);
  } else {
    state_.layer_editing = {};
    state_.controls = CameraControls(subject);
    lay_out(window_.size(), window_.pixels());  // with the panels of a scene
    state_.recorded = -1;
    if (!state_.stage->scene->cameras.empty())
      state_.controls.set_first_view(state_.stage->scene->cameras.front());
    state_.controls.reset();  // for this viewport
    state_.controls.arrive();
  }
  show_files_of_scene();
  for (const std::string& note : window_notes(state_.stage->scene->info)) state_.note(note);
}

}  // namespace tureen::viewer
