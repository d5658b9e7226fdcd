// Carries out requests for images, animations, camera paths and the command line.
#include <algorithm>
#include <span>

#include "base/error.hpp"
#include "base/memory_budget.hpp"
#include "base/output.hpp"
#include "camera/recorded_path.hpp"
#include "formats/dataset/camera_file.hpp"
#include "runtime/passes/accumulation.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"
#include "viewer/page_command.hpp"
#include "viewer/render_command.hpp"
#include "viewer/scene/saving.hpp"
#include "viewer/writing.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

/// Shows a note if there is no scene.
bool Application::has_scene() {
  if (!state_.stage) state_.note("There is no scene: open one first.");
  return state_.stage != nullptr;
}

/// An absolute path that no file has, and no image waiting to be written. Throws OutputError if the
/// user has typed a folder that does not exist.
fs::path Application::image_path(const std::string& extension) {
  std::error_code unknown;
  const fs::path folder = state_.folder_of_images();
  if (!options_.images.empty())
    make_folder(folder);
  else if (!fs::is_directory(folder, unknown))
    throw OutputError({folder.string(), {}, {}}, "there is no such folder",
                      "create it, or name another in the panel Image");
  const std::string stem =
      state_.stage ? fs::path(short_name(state_.source.path())).stem().string() : "tureen";
  for (int number = 1;; ++number) {
    fs::path path = folder / (stem + "-" + std::to_string(number) + extension);
    std::error_code ignored;
    if (fs::exists(path, ignored) ||
        std::find(promised_.begin(), promised_.end(), path) != promised_.end())
      continue;
    promised_.push_back(path);
    return path;
  }
}

void Application::carry_out(const TakeImage& request) {
  if (!has_scene()) return;
  const glm::ivec2 size = request.size.x > 0 ? request.size : state_.pixels;
  const bool by_rays = state_.trace && state_.debug_view.what == DebugView::color;
  const ImageJob job{.scene = state_.drawn_source(),
                     .camera = state_.controls.camera(size.x, size.y),
                     .debug_view = state_.debug_view,
                     .transparent = request.transparent,
                     .at_rest = state_.settings.smooth_at_rest,
                     .rays = by_rays ? traced_samples() : 0,
                     .path = image_path(".png")};
  const bool is_covered = state_.photograph() && state_.comparison.show != Comparison::Show::off;
  write(
      job.path, [job](const StageRequest& with) { write_image(job, with); },
      std::string(by_rays ? ", ray-traced" : "") +
          (is_covered ? ", the scene without the photograph" : ""));
}

void Application::carry_out(const SavePage&) {
  if (!has_scene()) return;
  if (!state_.source.is_from_files()) {
    state_.note("The page is made from files: save the changed layers as .glb first (Ctrl+S).");
    return;
  }
  const fs::path page = image_path(".html");
  fs::path view = page;
  view += ".camera.json";
  const Camera camera = state_.controls.camera(state_.pixels.x, state_.pixels.y);
  const std::vector<std::string> arguments = page_arguments(state_.source,
                                                            {.choice = state_.stage->choice,
                                                             .max_splats = options_.max_splats,
                                                             .max_memory = max_memory(),
                                                             .up = state_.controls.up(),
                                                             .view = view},
                                                            page);
  write(page, [arguments, page, view, camera](const StageRequest& with) {
    const TemporaryFile temporary(view);
    write_file(view, cameras_to_json(std::span(&camera, 1)));
    run_to_end(tureen_program(), arguments, page, [&] { with.progress(0); });
  });
}

void Application::carry_out(const WriteAnimation&) {
  if (!state_.stage || state_.animation.path.empty()) return;
  const Animation& animation = state_.animation;
  static constexpr const char* endings[] = {"-frames", ".mp4", ".webm"};
  const AnimationJob job{.scene = state_.drawn_source(),
                         .path = animation.path,
                         .rate = {animation.frames_per_second, animation.size.x, animation.size.y},
                         .output = image_path(endings[int(animation.output)])};
  write(job.output, [job](const StageRequest& with) { write_animation(job, with); });
}

void Application::write(const fs::path& path, std::function<void(const StageRequest&)> work,
                        const std::string& remark) {
  const auto job = [this, path, remark, work = std::move(work),
                    choice = state_.stage->choice](const Worker::Progress& progress) {
    work({window_.context(), choice, progress});
    return Worker::Completion(
        [this, path, remark] { state_.note("Saved as " + path.string() + remark + "."); });
  };
  const auto failed = [this, path](const std::string& reason) {
    state_.error(short_name(path) + " was not written", reason);
  };
  writer_.start({.kind = JobKind::writing,
                 .what = "writing " + short_name(path),
                 .work = job,
                 .failed = failed});
}

void Application::carry_out(const StopWriting&) {
  writer_.abandon(JobKind::writing);
  quit_when_written_.reset();
  state_.note("Cancelled.");
}

void Application::carry_out(const AddKeyframe&) {
  if (!has_scene()) return;
  Animation& animation = state_.animation;
  // Default time between views, in seconds.
  constexpr double apart = 1.5;
  const auto& keyframes = animation.path.data().keyframes;
  const double at = keyframes.empty() ? 0 : keyframes.back().seconds + apart;
  const bool loop = animation.path.is_loop();
  animation.selected = int(animation.path.add(state_.keyframe_of_now(at)));
  if (loop) animation.path.set_loop_seconds(animation.path.data().loop_seconds + apart);
  animation.seconds = at - animation.path.begin();
}

void Application::carry_out(const ShowKeyframe& request) {
  const auto& keyframes = state_.animation.path.data().keyframes;
  if (request.index < keyframes.size()) state_.controls.adopt(keyframes[request.index].camera);
}

void Application::carry_out(const MakeTurntable&) {
  if (!has_scene()) return;
  state_.animation.begin(
      turntable({.first = state_.controls.camera(state_.pixels.x, state_.pixels.y),
                 .distance = state_.controls.distance(),
                 .up = state_.controls.up(),
                 .seconds = state_.animation.turn_seconds}));
}

void Application::carry_out(const FlyAlongCameras&) {
  std::vector<Camera> cameras;
  for (const Camera* camera : state_.recorded_cameras()) cameras.push_back(*camera);
  CameraPathData path = path_along(cameras);
  if (path.keyframes.empty()) return state_.note("The scene has no recorded cameras.");
  state_.animation.begin(std::move(path));
  state_.animation.toggle();
}

void Application::carry_out(const SavePath& request) {
  write_file(request.file, path_to_json(state_.animation.path.data()));
  std::error_code unknown;
  const fs::path path = fs::absolute(request.file, unknown).lexically_normal();
  state_.note("Saved as " + path.string() + ".");
}

void Application::carry_out(const LoadPath& request) {
  state_.animation.begin(read_path(request.file));
  state_.animation.file = request.file.string();
}

void Application::carry_out(const CopyCommand&) {
  if (!has_scene()) return;
  const Camera camera = state_.controls.camera(state_.pixels.x, state_.pixels.y);
  fs::path file;
  if (needs_camera_file(camera)) {
    file = image_path(".camera.json");
    write_file(file, cameras_to_json(std::span(&camera, 1)));
  }
  DrawingChoice choice = state_.stage->choice;
  if (state_.settings.smooth_at_rest && state_.stage->renderer.has_image_at_rest()) {
    choice.quality = quality_of(choice, *state_.source.scene);
    choice.quality->supersampling = samples_at_rest;
  }
  const int rays = state_.trace ? traced_samples() : 0;
  const auto copy = [this, choice, debug_view = state_.debug_view, camera, file, rays](
                        const SceneSource& source, std::optional<std::uint64_t> max_splats) {
    window_.set_clipboard(
        render_command(source, choice, debug_view, camera, file, max_splats, rays));
    state_.note("Copied the command for this image to the clipboard");
  };
  if (state_.source.is_from_files()) return copy(state_.source, options_.max_splats);
  // Layers that exist only in memory: the command draws a file with all layers.
  const fs::path glb = image_path(".glb");
  const auto work = [this, copy, glb, source = state_.source](const Worker::Progress& progress) {
    progress(0);
    auto saved = std::make_shared<Saved>(save_scene(source, glb, true));
    return Worker::Completion([this, copy, glb, source, saved] {
      SceneSource written = source;
      adopt_file(written, source, std::move(saved->file));
      copy(written, {});
      state_.note("It draws " + glb.string() + ", which was saved for it.");
    });
  };
  const auto failed = [this, glb](const std::string& reason) {
    state_.error(short_name(glb) + " was not saved", reason);
  };
  writer_.start({.kind = JobKind::writing,
                 .what = "saving " + short_name(glb),
                 .work = work,
                 .failed = failed});
}

}  // namespace tureen::viewer
