// Carries out requests for scenes, datasets and the method of drawing.
#include <algorithm>
#include <iterator>
#include <utility>

#include "base/extension.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "jobs/cameras/camera_run.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Seconds between checks of the scene's files.
constexpr double watch_seconds = 1.0;

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
      state_.error("The request failed", error.what());
    }
    frames_wanted_ = std::max(frames_wanted_, 2);
  }
}

void Application::carry_out(const OpenPath& request) {
  if (open_other(request.path, state_)) return;
  if (is_photographs(request.path) && !is_scene(request.path))
    return ask_about_photographs(request.path);
  if (request.discards || !asks_before({request.path})) load({Relation::other, {request.path}});
}

void Application::carry_out(const AddPaths& request) {
  Loading loading{.relation = state_.stage ? Relation::grown : Relation::other, .paths = {}};
  // A new job replaces the running one, so it also reads that one's files.
  if (loading_) loading = *loading_;
  bool has_scenes = false, has_photographs = false;
  for (const fs::path& path : request.paths) {
    if (open_other(path, state_)) continue;
    if (is_photographs(path) && !is_scene(path)) {
      if (std::exchange(has_photographs, true))
        state_.note("One folder of photographs opens at a time: " + short_name(path) +
                    " was left out.");
      else
        ask_about_photographs(path);
      continue;
    }
    loading.paths.push_back(path);
    has_scenes = true;
  }
  if (has_scenes) load(loading);
}

void Application::carry_out(const ReloadScene&) { reload(); }
void Application::carry_out(const ChooseLevel& request) { reload(request); }

void Application::reload(std::optional<ChooseLevel> level) {
  if (!state_.stage) return;
  Loading loading{.relation = Relation::changed, .paths = {}, .level = level};
  // A new job replaces the running one, so it also adds that one's files.
  if (loading_ && loading_->relation != Relation::other) loading.paths = loading_->paths;
  load(loading);
}

void Application::carry_out(const OpenPhotographs& request) {
  const fs::path& path = request.path;
  const auto work = [this, path, trains = request.trains](const Worker::Progress& progress) {
    auto dataset = std::make_shared<Dataset>(read_dataset(path, {.progress = progress}));
    return Worker::Completion([this, path, dataset, trains] {
      state_.messages.dismiss_opening();
      FullPhotographs full;
      if (!dataset->train.empty()) full = full_photographs(dataset->train);
      Photographs photographs{.path = path,
                              .list = std::move(dataset->train),
                              .train_count = 0,
                              .notes = described(dataset->remarks),
                              .full = std::move(full),
                              .stay_is_noted = false};
      photographs.train_count = photographs.list.size();
      std::move(dataset->test.begin(), dataset->test.end(), std::back_inserter(photographs.list));
      state_.photographs = std::move(photographs);
      state_.recorded = -1;
      state_.comparison = {};
      state_.note(std::to_string(state_.photographs->list.size()) +
                  " photographs: [ and ] select their cameras, C compares.");
      if (trains) state_.ask(OfferTraining{.is_for_photographs = true});
    });
  };
  const auto failed = [this, path](const std::string& reason) {
    state_.error(short_name(path) + " cannot be read", reason, Message::About::opening);
  };
  worker_.start({.kind = JobKind::dataset,
                 .what = "reading the photographs of " + short_name(path),
                 .work = work,
                 .failed = failed});
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
    state_.note(short_names(state_.source.paths()) + " has changed: reading it again.");
  state_.ask(ReloadScene{});
}

void Application::carry_out(const CancelJob& request) {
  if (!can_be_cancelled(request.kind)) return;
  (request.kind == JobKind::cameras ? searcher_ : worker_).abandon(request.kind);
  if (request.kind == JobKind::scene) loading_.reset();
  if (request.kind == JobKind::drawing) {
    preparing_drawing_ = false;
    if (state_.stage) keep_drawn_options();
  }
  const bool in_part = request.kind == JobKind::scene && shows_preview();
  state_.note(in_part                            ? "Cancelled. The scene is shown only in part."
              : request.kind == JobKind::cameras ? "Cancelled. The next search for these cameras "
                                                   "continues from here."
                                                 : "Cancelled.");
}

void Application::carry_out(const ChooseDrawing& request) {
  if (!state_.stage) return;
  state_.wanted = request.choice;
  preparing_drawing_ = true;
  const auto failed = [this](const std::string& reason) {
    preparing_drawing_ = false;
    keep_drawn_options();
    state_.error("The drawing options cannot be applied", reason);
  };
  prepare(JobKind::drawing, false, failed);
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

void Application::carry_out(const Quit& request) {
  if (!request.discards && !writer_.idle() && !quit_when_written_) {
    quit_when_written_ = request;
    quit_asked_ = state_.now;
    return state_.note("The window closes when all files are written. Quit again to stop that.");
  }
  quit_when_written_.reset();
  if (!request.discards && asks_before({})) return;
  state_.asks_before_quitting = request.training == Quit::Training::ask && training_program_;
  if (state_.asks_before_quitting) return;
  if (request.training == Quit::Training::stop) carry_out(StopTraining{});
  quit_ = true;
}

}  // namespace tureen::viewer
