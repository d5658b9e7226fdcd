// Carries out requests for scenes, datasets and the method of drawing.
#include <algorithm>
#include <iterator>

#include "base/extension.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Seconds between checks of the scene's file.
constexpr double watch_seconds = 1.0;

/// Whether read_dataset() reads this path. Scenes in folders have no photographs.
bool looks_like_photographs(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return path.filename() == "transforms.json";
  for (const char* mark : {"transforms.json", "transforms_train.json", "sparse", "colmap"})
    if (fs::exists(path / mark, ignored)) return true;
  return false;
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
  const std::string name = request.path.filename().string();
  if (name == "transforms_train.json" || name == "transforms_test.json")
    state_.ask(OpenPhotographs{fs::absolute(request.path).parent_path()});
  else if (looks_like_photographs(request.path))
    state_.ask(OpenPhotographs{request.path});
  else if (extension_of(request.path) == ".json")
    state_.ask(LoadPath{request.path});
  else
    open_scene(request.path, false);
}

void Application::open_scene(const fs::path& path, bool keep_view) {
  worker_.abandon(JobKind::drawing);
  const DrawingChoice choice = state_.stage ? state_.wanted : options_.drawing;
  worker_.start(
      {.kind = JobKind::scene,
       .what = "reading " + short_name(path),
       .work =
           [this, path, choice, keep_view](const Worker::Progress& progress) {
             std::shared_ptr<Stage> stage = read_stage(path, {window_.context(), choice, progress});
             return Worker::Completion([this, stage = std::move(stage), keep_view]() mutable {
               show(std::make_unique<Stage>(std::move(*stage)), keep_view);
             });
           },
       .failed =
           [this, path](const std::string& reason) {
             state_.messages.error(short_name(path) + " cannot be shown", reason, state_.now);
           }});
}

void Application::show(std::unique_ptr<Stage> stage, bool keep_view) {
  const bool same_scene = state_.stage && state_.stage->scene == stage->scene;
  const bool other_path = !state_.stage || state_.stage->path != stage->path;
  state_.stage = std::move(stage);
  state_.wanted = state_.stage->choice;
  image_is_current_ = false;
  worker_.abandon(JobKind::debug_view);
  worker_.abandon(JobKind::comparison);
  preparing_debug_views_.reset();
  state_.comparison.forget();
  frame_clock_.clear();
  if (same_scene) return;  // only the method of drawing changed
  state_.debug_view.features = {};
  if (why_not(state_.debug_view.what, state_.stage->soup()))
    state_.debug_view.what = DebugView::color;
  if (!state_.photographs && state_.recorded >= int(state_.stage->scene->cameras.size()))
    state_.recorded = -1;
  const Subject& subject = state_.stage->subject;
  if (keep_view && !other_path) {
    state_.controls.set_box(subject.low, subject.high);
  } else {
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
  watch_ = state_.stage->watch;
  remember(state_.settings, state_.stage->path);
  window_.set_title(short_name(state_.stage->path) + " - Tureen");
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
                                        " photographs: [ and ] select their cameras, C compares",
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

void Application::carry_out(const ReloadScene&) {
  if (state_.stage) open_scene(state_.stage->path, true);
}

void Application::watch_file() {
  // Not while another scene is loading: a reload of this one would replace it.
  if (!state_.stage || state_.busy || state_.now - watched_ < watch_seconds) return;
  watched_ = state_.now;
  if (!watch_.changed()) return;
  state_.messages.note(short_name(state_.stage->path) + " has changed: reading it again",
                       state_.now);
  state_.ask(ReloadScene{});
}

void Application::carry_out(const ChooseDrawing& request) {
  if (!state_.stage) return;
  state_.wanted = request.choice;
  // The job keeps the scene alive, even if the stage changes meanwhile.
  auto from = std::make_shared<StageSource>(state_.stage->source());
  worker_.start({.kind = JobKind::drawing,
                 .what = "preparing " + short_name(state_.stage->path),
                 .work =
                     [this, from, choice = request.choice](const Worker::Progress& progress) {
                       std::shared_ptr<Stage> stage =
                           prepare_stage(*from, {window_.context(), choice, progress});
                       return Worker::Completion([this, stage]() mutable {
                         // Another scene may have been loaded meanwhile.
                         if (!state_.stage || state_.stage->scene != stage->scene) return;
                         show(std::make_unique<Stage>(std::move(*stage)), true);
                       });
                     },
                 .failed =
                     [this](const std::string& reason) {
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

void Application::carry_out(const ToggleFullscreen&) {
  window_.set_fullscreen(!window_.fullscreen());
}

void Application::carry_out(const Quit&) { quit_ = true; }

}  // namespace tureen::viewer
