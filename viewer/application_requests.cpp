// Carries out requests for scenes, datasets and the method of drawing.
#include <algorithm>
#include <iterator>

#include "base/extension.hpp"
#include "formats/dataset/dataset.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Seconds between checks of the scene's files.
constexpr double watch_seconds = 1.0;

/// Fraction of the progress bar for reading; the rest is for preparation.
constexpr double reading_share = 0.9;

/// Whether the path is no scene, but photographs or a camera path; then asks for them.
bool open_other(const fs::path& path, State& state) {
  const std::string name = path.filename().string();
  if (name == "transforms_train.json" || name == "transforms_test.json")
    state.ask(OpenPhotographs{fs::absolute(path).parent_path()});
  else if (is_dataset(path))
    state.ask(OpenPhotographs{path});
  else if (extension_of(path) == ".json")
    state.ask(LoadPath{path});
  else
    return false;
  return true;
}

}  // namespace

void Application::carry_out() {
  while (!state_.requests.empty()) {
    const Request request = std::move(state_.requests.front());
    state_.requests.pop_front();
    try {
      std::visit([this](const auto& each) { carry_out(each); }, request);
    } catch (const std::exception& error) {
      state_.messages.error("The request failed", error.what(), state_.now);
    }
    frames_wanted_ = std::max(frames_wanted_, 2);
  }
}

void Application::carry_out(const OpenPath& request) {
  if (!open_other(request.path, state_)) load({Relation::other, {request.path}});
}

void Application::carry_out(const AddPaths& request) {
  Loading loading{.relation = state_.stage ? Relation::grown : Relation::other, .paths = {}};
  // A new job replaces the running one, so it also reads that one's files.
  if (loading_) loading = *loading_;
  bool has_scenes = false;
  for (const fs::path& path : request.paths) {
    if (open_other(path, state_)) continue;
    loading.paths.push_back(path);
    has_scenes = true;
  }
  if (has_scenes) load(loading);
}

void Application::carry_out(const ReloadScene&) {
  if (!state_.stage) return;
  Loading loading{.relation = Relation::changed, .paths = {}};
  // A new job replaces the running one, so it also adds that one's files.
  if (loading_ && loading_->relation != Relation::other) loading.paths = loading_->paths;
  load(loading);
}

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
  worker_.start({.kind = JobKind::scene,
                 .what = "reading " + short_names(named),
                 .work =
                     [this, loading, before, choice, files](const Worker::Progress& progress) {
                       return load_in_background(loading, before,
                                                 {window_.context(), choice, progress}, files);
                     },
                 .failed =
                     [this, files](const std::string& reason) {
                       files->failures.push_back({files->current, reason});
                       end_loading(*files);
                     }});
}

void Application::end_loading(const Reading& files) {
  loading_.reset();
  for (const Reading::Failure& each : files.failures)
    state_.messages.error(short_name(each.path) + " cannot be shown", each.reason, state_.now);
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
      end_loading(*files);
      add(addition);
    };
  }
  const bool again = loading.relation == Relation::changed;
  std::shared_ptr<Stage> stage =
      prepare_fitting_stage(again ? read_again(*before, reading) : read_source(reading), preparing);
  return [this, stage = std::move(stage), relation = loading.relation, files] {
    end_loading(*files);
    show(std::make_unique<Stage>(std::move(*stage)), relation);
  };
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
  for (const std::string& note : all_notes(stage.scene->info))
    if (std::find(known.begin(), known.end(), note) == known.end())
      state_.messages.note(note, state_.now);
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
  const auto prepare =
      state_.debug_view.what == DebugView::color ? prepare_stage : prepare_debug_stage;
  loading_ = Loading{.relation = Relation::grown, .paths = {}};
  for (std::size_t i = state_.stage->files.size(); i < source.files.size(); ++i)
    loading_->paths.push_back(source.files[i].path);
  worker_.start(
      {.kind = JobKind::scene,
       .what = "preparing " + short_names(source.paths()),
       .work =
           [this, source, prepare, choice = state_.wanted](const Worker::Progress& progress) {
             std::shared_ptr<Stage> stage = prepare(source, {window_.context(), choice, progress});
             return Worker::Completion([this, stage = std::move(stage)] {
               loading_.reset();
               show(std::make_unique<Stage>(std::move(*stage)), Relation::grown);
             });
           },
       .failed =
           [this, name = short_name(source.files.back().path)](const std::string& reason) {
             loading_.reset();
             state_.messages.error(name + " cannot be shown", reason, state_.now);
           }});
}

void Application::carry_out(const ArrangeLayers& request) {
  if (!state_.stage || state_.stage->scene != request.scene) return;
  const std::vector<fs::path> before = state_.stage->paths();
  arrange_layers(*state_.stage, request.layers);
  after_change_of_layers();
  if (state_.stage->paths() != before) show_files_of_scene();
}

void Application::after_change_of_layers() {
  const Subject& subject = state_.stage->subject;
  state_.controls.set_box(subject.low, subject.high);
  if (why_not(state_.debug_view.what, *state_.stage)) state_.debug_view.what = DebugView::color;
  state_.comparison.forget();
  worker_.abandon(JobKind::comparison);
  image_is_current_ = false;
}

void Application::report_refused(const std::vector<RefusedLayer>& layers) {
  for (const RefusedLayer& layer : layers)
    state_.messages.error("The layer " + layer.name + " does not fit the device's memory",
                          describe(layer), state_.now);
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

void Application::show(std::unique_ptr<Stage> stage, Relation relation) {
  const bool same_scene = state_.stage && state_.stage->scene == stage->scene;
  const bool keep_view = state_.stage && relation != Relation::other;
  if (keep_view) {
    // The user may have changed layers meanwhile.
    StageSource now = stage->source();
    keep_changes(now, *state_.stage);
    arrange_layers(*stage, std::move(now.layers));
  }
  state_.stage = std::move(stage);
  state_.wanted = state_.stage->choice;
  image_is_current_ = false;
  worker_.abandon(JobKind::debug_view);
  worker_.abandon(JobKind::comparison);
  preparing_debug_views_.reset();
  state_.comparison.forget();
  frame_clock_.clear();
  if (same_scene) return;  // only the method of drawing changed
  preparing_drawing_ = false;
  report_refused(state_.stage->refused);
  state_.debug_view.features = {};
  if (why_not(state_.debug_view.what, *state_.stage)) state_.debug_view.what = DebugView::color;
  if (!state_.photographs && state_.recorded >= int(state_.stage->scene->cameras.size()))
    state_.recorded = -1;
  const Subject& subject = state_.stage->subject;
  if (keep_view) {
    state_.controls.set_box(subject.low, subject.high);
  } else {
    state_.layer_editing = {};
    state_.controls = CameraControls(subject);
    lay_out(window_.size(), window_.pixels());  // with the panels of a scene
    state_.controls.home();                     // for this viewport
    state_.controls.arrive();
    state_.recorded = -1;
    if (!state_.stage->scene->cameras.empty()) {
      state_.controls.set_first_view(state_.stage->scene->cameras.front());
      state_.controls.reset();
      state_.controls.arrive();
    }
  }
  show_files_of_scene();
  for (const std::string& note : all_notes(state_.stage->scene->info))
    state_.messages.note(note, state_.now);
}

void Application::carry_out(const OpenPhotographs& request) {
  const fs::path& path = request.path;
  worker_.start(
      {.kind = JobKind::dataset,
       .what = "reading the photographs of " + short_name(path),
       .work =
           [this, path](const Worker::Progress& progress) {
             auto dataset = std::make_shared<Dataset>(read_dataset(path, {.progress = progress}));
             return Worker::Completion([this, path, dataset] {
               Photographs photographs{.path = path,
                                       .list = std::move(dataset->train),
                                       .train_count = 0,
                                       .notes = described(dataset->remarks)};
               photographs.train_count = photographs.list.size();
               std::move(dataset->test.begin(), dataset->test.end(),
                         std::back_inserter(photographs.list));
               state_.photographs = std::move(photographs);
               state_.recorded = -1;
               state_.comparison = {};
               state_.messages.note(std::to_string(state_.photographs->list.size()) +
                                        " photographs: [ and ] select their cameras, C compares.",
                                    state_.now);
             });
           },
       .failed =
           [this, path](const std::string& reason) {
             state_.messages.error(short_name(path) + " cannot be read", reason, state_.now);
           }});
}

void Application::carry_out(const CloseDataset&) {
  worker_.abandon(JobKind::comparison);
  state_.photographs.reset();
  state_.comparison = {};
  state_.recorded = -1;
}

void Application::watch_files() {
  if (state_.now - watched_ < watch_seconds) return;
  watched_ = state_.now;
  watch_training_program();
  if (state_.training && state_.training->update()) frames_wanted_ = std::max(frames_wanted_, 1);
  // Not while another scene is loading: a reload of this one would replace it.
  if (!state_.stage || state_.busy) return;
  bool changed = false;
  for (FileWatch& watch : watches_) changed |= watch.changed();
  if (!changed) return;
  if (!state_.training)  // changes every few seconds
    state_.messages.note(short_names(state_.stage->paths()) + " has changed: reading it again.",
                         state_.now);
  state_.ask(ReloadScene{});
}

void Application::carry_out(const CancelJob& request) {
  if (!can_be_cancelled(request.kind)) return;
  worker_.abandon(request.kind);
  if (request.kind == JobKind::scene) loading_.reset();
  if (request.kind == JobKind::drawing) {
    preparing_drawing_ = false;
    if (state_.stage) state_.wanted = state_.stage->choice;
  }
  state_.messages.note("Cancelled.", state_.now);
}

void Application::carry_out(const ChooseDrawing& request) {
  if (!state_.stage) return;
  state_.wanted = request.choice;
  preparing_drawing_ = true;
  // The job keeps the scene alive, even if the stage changes meanwhile.
  auto from = std::make_shared<StageSource>(state_.stage->source());
  worker_.start({.kind = JobKind::drawing,
                 .what = "preparing " + short_names(state_.stage->paths()),
                 .work =
                     [this, from, choice = request.choice](const Worker::Progress& progress) {
                       std::shared_ptr<Stage> stage =
                           prepare_stage(*from, {window_.context(), choice, progress});
                       return Worker::Completion([this, stage]() mutable {
                         // Another scene may have been loaded meanwhile.
                         if (!state_.stage || state_.stage->scene != stage->scene) return;
                         preparing_drawing_ = false;
                         show(std::make_unique<Stage>(std::move(*stage)), Relation::changed);
                       });
                     },
                 .failed =
                     [this](const std::string& reason) {
                       preparing_drawing_ = false;
                       if (state_.stage) state_.wanted = state_.stage->choice;
                       state_.messages.error("The drawing options cannot be applied", reason,
                                             state_.now);
                     }});
}

void Application::carry_out(const ShowRecorded& request) {
  const std::vector<const Camera*> cameras = state_.recorded_cameras();
  if (request.index < 0 || request.index >= int(cameras.size())) return;
  state_.recorded = request.index;
  state_.controls.adopt(*cameras[std::size_t(request.index)]);
  state_.comparison.forget();
}

void Application::carry_out(const FocusAt& request) {
  if (!state_.stage) return;
  Renderer& renderer = state_.stage->renderer;
  renderer.draw({state_.controls.camera(state_.pixels.x, state_.pixels.y)});
  image_is_current_ = false;  // the last one may have had another view
  const glm::dvec2 scale = glm::dvec2(state_.pixels) / glm::dvec2(state_.points);
  if (const auto point = renderer.point_at(request.place * scale)) state_.controls.focus(*point);
}

void Application::carry_out(const TellTraining& request) {
  if (state_.training) state_.training->send(request.command);
}

void Application::carry_out(const ToggleFullscreen&) {
  window_.set_fullscreen(!window_.fullscreen());
}

void Application::carry_out(const Quit&) { quit_ = true; }

}  // namespace tureen::viewer
