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
  std::shared_ptr<SceneSource> before;  // the job must not use the source, which changes
  if (loading.relation != Relation::other) before = std::make_shared<SceneSource>(state_.source);
  // A drawing job of the same scene stays: it is finished before the new layers are read.
  if (loading.relation != Relation::grown) {
    worker_.abandon(JobKind::drawing);
    preparing_drawing_ = false;
  }
  DrawingChoice choice = state_.stage ? state_.wanted : options_.drawing;
  if (loading.relation == Relation::other) {  // the document has these, and a new one begins
    choice.quality = options_.drawing.quality;
    choice.plan.splat_profile = options_.drawing.plan.splat_profile;
  }
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
                                                   const std::shared_ptr<SceneSource>& before,
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
      .max_splats = options_.max_splats,
      .lod = options_.lod,
      .level = loading.level ? std::optional(std::pair(loading.level->file, loading.level->level))
                             : std::nullopt};
  const StageRequest preparing{request.context, request.choice, [&](double done) {
                                 request.progress(reading_share + (1 - reading_share) * done);
                               }};
  if (loading.relation == Relation::grown) {
    const auto source = std::make_shared<SceneSource>(read_more(*before, reading));
    return [this, source, before, files] {
      state_.messages.dismiss_opening();
      end_loading(*files, Relation::grown);
      add(*source, *before);
    };
  }
  const bool again = loading.relation == Relation::changed;
  if (!again && loading.paths.size() == 1) post_previews(loading.paths.front(), request, files);
  const auto source =
      std::make_shared<SceneSource>(again ? read_again(*before, reading) : read_source(reading));
  SceneSource drawn = *source;
  if (again) keep_changes(drawn, *before);
  const std::shared_ptr<Stage> stage = prepare_stage(drawn, preparing);
  return
      [this, source, stage, relation = loading.relation, is_alone = loading.paths.empty(), files] {
        // A changed file is not another one, unless it was read together with further files.
        if (relation == Relation::changed && is_alone)
          state_.messages.dismiss_scene();
        else
          state_.messages.dismiss_opening();
        end_loading(*files, relation);
        show_read(std::move(*source), std::move(*stage), relation, *files);
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
    const DocumentLayer& layer = preview->source.document.layers.front();
    if (splats_of(layer) && options_.max_splats && primitive_count(layer) > *options_.max_splats)
      return;
    std::shared_ptr<Stage> stage;
    try {
      stage = prepare_stage(preview->source, {request.context, request.choice, check});
    } catch (const Error&) {
      return;  // if the whole scene is refused too, its preparation reports the reason
    }
    worker_.post([this, stage, source = std::make_shared<SceneSource>(preview->source), reading] {
      show_read(std::move(*source), std::move(*stage), Relation::other, *reading);
      preview_ = Preview{reading, opened_};
    });
  }
}

bool Application::shows_preview() const { return preview_ && preview_->opened == opened_; }

bool Application::shows_preview_of(const Reading& reading) const {
  return shows_preview() && preview_->reading.get() == &reading;
}

/// Keeps what the user changed on a preview of the same file. Without changes, the scene is shown
/// as if there had been no preview.
void Application::show_read(SceneSource source, Stage stage, Relation relation,
                            const Reading& reading) {
  std::optional<DrawingChoice> chosen;
  if (shows_preview_of(reading)) {
    if (!state_.controls.goes_to_first_view() || !state_.history.steps().empty())
      relation = Relation::changed;
    if (preparing_drawing_) chosen = state_.wanted;
  }
  if (relation == Relation::changed)
    show_again(std::move(source), std::move(stage));
  else
    show_opened(std::move(source), std::move(stage));
  if (chosen) state_.ask(ChooseDrawing{*chosen});
}

/// Adds the layers of files that were read after those of `known`.
void Application::add(const SceneSource& more, const SceneSource& known) {
  SceneSource& source = state_.source;
  const std::vector<std::string> notes = named_notes(source);
  const AddLayers edit = add_files(source, more, known);
  if (edit.layers.empty()) return;
  state_.history.perform(source.document, edit);
  merge_files(source);
  for (const std::string& note : window_notes(source.scene->info))
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) state_.note(note);
  state_.layer_editing.selected = source.document.layers.back().id;
  state_.debug_view.features = {};
  follow_document();
}

void Application::report_refused(const std::vector<RefusedLayer>& layers) {
  for (const RefusedLayer& refused : layers)
    state_.error("The layer " + refused.layer.name + " does not fit the device's memory",
                 describe(refused), Message::About::scene);
}

/// After a change of the files.
void Application::show_files_of_scene() {
  const SceneSource& source = state_.source;
  watches_.clear();
  for (std::size_t i = 0; i < source.files.size(); ++i)
    if (has_layers(source, i)) watches_.push_back(source.files[i].watch);
  // The first file comes first in the list of recent files.
  const std::vector<fs::path> paths = source.paths();
  for (auto path = paths.rbegin(); path != paths.rend(); ++path) remember(state_.settings, *path);
  shown_paths_ = paths;
}

void Application::show_notes() {
  for (const std::string& note : window_notes(state_.source.scene->info)) state_.note(note);
}

/// A scene that begins a new document.
void Application::show_opened(SceneSource source, Stage stage) {
  const bool replaces = state_.stage != nullptr;
  state_.source = std::move(source);
  Document& document = state_.source.document;
  document.quality = quality_of(stage.choice, *state_.source.scene);
  document.profile = stage.choice.plan.splat_profile;
  state_.history = History();
  refused_quality_.reset();
  shown_paths_.clear();
  preparing_drawing_ = false;
  ++opened_;
  if (replaces && state_.photographs && !std::exchange(state_.photographs->stay_is_noted, true))
    state_.note("The photographs of " + short_name(state_.photographs->path) +
                " stay open. Close them in Photographs.");
  state_.stage.reset();  // all layers that it refused are reported
  show(std::move(stage));
  state_.debug_view.features = {};
  state_.layer_editing = {};
  state_.controls = CameraControls(state_.source.subject);
  lay_out(window_.size(), window_.pixels());  // with the panels of a scene
  state_.recorded = -1;
  state_.controls.set_first_view(first_view_of(state_.source));
  state_.controls.reset();  // for this viewport
  state_.controls.arrive();
  follow_document();
  show_notes();
}

/// The files of the document, read again: it stays, with its history.
void Application::show_again(SceneSource read, Stage stage) {
  for (const DocumentLayer& layer : read.document.layers) state_.history.replace_primitives(layer);
  keep_changes(read, state_.source);
  state_.source = std::move(read);
  preparing_drawing_ = false;
  show(std::move(stage));
  state_.debug_view.features = {};
  if (!state_.photographs && state_.recorded >= int(state_.source.scene->cameras.size()))
    state_.recorded = -1;
  shown_paths_.clear();
  follow_document();
  show_notes();
}

}  // namespace tureen::viewer
