// `tureen render`: pictures of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "cli/commands.hpp"
#include "cli/contact_sheet.hpp"
#include "cli/drawing_options.hpp"
#include "cli/interrupt.hpp"
#include "cli/picture_file.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/scene_argument.hpp"
#include "cli/values.hpp"
#include "cli/view_options.hpp"
#include "formats/video_file.hpp"
#include "runtime/renderer.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

struct Options {
  SceneArgument scene;
  ViewOptions views;
  std::string output = "out.png";
  std::string background;  // empty: the scene's own
  DrawingOptions drawing;
  int frames = 0;
  bool json = false;
};

/// Milliseconds a frame, each from before the draw to after the device has finished.
struct FrameTimes {
  std::vector<double> ms;

  double median() const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
  }
  /// The smallest that 95 % of all are not above.
  double p95() const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[(sorted.size() * 95 + 99) / 100 - 1];
  }
};

double timed_draw(Renderer& renderer, const Camera& camera) {
  const auto start = std::chrono::steady_clock::now();
  renderer.draw(camera);
  renderer.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// `frames` frames through all cameras in turn. The first ones, which compile shaders and fill
/// caches, are drawn before and not counted.
FrameTimes benchmark(Renderer& renderer, const std::vector<Camera>& cameras, int frames) {
  const int warm_up = std::clamp(frames, 3, 10);
  Progress progress("timing");
  FrameTimes times;
  for (int i = -warm_up; i < frames; ++i) {
    const double ms = timed_draw(renderer, cameras[std::size_t(i + warm_up) % cameras.size()]);
    if (i >= 0) times.ms.push_back(ms);
    progress.update(double(i + warm_up + 1) / (frames + warm_up));
  }
  return times;
}

struct Pictures {
  std::vector<std::string> paths;
  FrameTimes times;
};

/// Frame by frame into one file.
Pictures draw_video(Renderer& renderer, const Views& film, const std::string& path) {
  const std::vector<Camera>& cameras = film.cameras;
  const Camera& first = cameras.front();
  Pictures result{{path}, {}};
  VideoFile video(path, {first.width, first.height, film.frames_per_second});
  Progress progress("drawing");
  timed_draw(renderer, first);  // compiles shaders; not counted
  for (const Camera& camera : cameras) {
    progress.update(double(result.times.ms.size()) / double(cameras.size()));
    result.times.ms.push_back(timed_draw(renderer, camera));
    video.add(renderer.read_color());
  }
  video.commit();
  return result;
}

Pictures draw_pictures(Renderer& renderer, const Views& views, const std::string& pattern) {
  const std::vector<Camera>& cameras = views.cameras;
  // Frames follow each other: a sheet of hundreds shows nothing.
  const bool with_sheet = cameras.size() > 1 && views.frames_per_second == 0;
  const int count = int(cameras.size());
  Pictures result;
  std::vector<Image8> thumbnails;
  Progress progress("drawing");
  timed_draw(renderer, cameras.front());  // compiles shaders; not counted
  for (int i = 0; i < count; ++i) {
    progress.update(double(i) / count);
    result.times.ms.push_back(timed_draw(renderer, cameras[std::size_t(i)]));
    const Image8 picture = renderer.read_color();
    const std::filesystem::path path = picture_name(pattern, i, count);
    write_picture(picture, path);
    result.paths.push_back(path.string());
    if (with_sheet) thumbnails.push_back(thumbnail(picture));
  }
  if (with_sheet) {
    const std::filesystem::path sheet =
        picture_name(pattern, 0, count).replace_filename("contact_sheet.png");
    write_picture(contact_sheet(thumbnails), sheet);
    result.paths.push_back(sheet.string());
  }
  return result;
}

/// Throws UsageError.
void check_output(const Options& options, const glm::vec4& background) {
  if (!is_video_name(options.output)) {
    require_png_name(options.output);
    picture_name(options.output, 0, std::max(options.views.orbit, 1));
    return;
  }
  if (!options.views.is_film())
    throw UsageError("'" + options.output +
                     "' is a video, which shows the frames of --path or "
                     "--turntable");
  if (!options.background.empty() && background.a < 1)
    throw UsageError(
        "a video shows no transparency: leave --background transparent away, or write "
        "pictures, -o frame_%04d.png");
  if (!have_ffmpeg()) throw UsageError(ffmpeg_missing);
}

/// What was written, for people: each file, or the first and last frame.
void say_written(const Pictures& pictures, const Views& views) {
  const std::vector<std::string>& paths = pictures.paths;
  if (views.frames_per_second > 0)
    say(fmt::format("{} frames, {:.2f} s at {:g} a second", views.cameras.size(),
                    double(views.cameras.size()) / views.frames_per_second,
                    views.frames_per_second));
  if (views.frames_per_second > 0 && paths.size() > 2) {
    say("wrote " + paths.front() + " to " + paths.back());
    return;
  }
  for (const std::string& path : paths) say("wrote " + path);
}

ExitCode render(Options options) {
  // Everything that can be wrong with the arguments is said before the scene is read.
  check(options.views);
  glm::vec4 background(0.0f);
  if (!options.background.empty()) background = parse_background(options.background);
  check_output(options, background);

  Scene scene = read(options.scene);
  const TriangleSoup& soup = opaque_soup(scene);
  const Views views = resolve_views(options.views, scene, options.scene.path);
  if (options.background.empty()) background = glm::vec4(scene.info.background, 1.0f);
  use_preset_of(scene, options.drawing);

  const gl::Context context = gl::Context::create({.backend = options.drawing.backend});
  throw_if_interrupted();
  CheckedRenderer checked = make_renderer(context, soup, scene.origin, options.drawing, background);
  Renderer& renderer = checked.renderer;

  Pictures pictures = is_video_name(options.output)
                          ? draw_video(renderer, views, options.output)
                          : draw_pictures(renderer, views, options.output);
  if (options.frames > 0) pictures.times = benchmark(renderer, views.cameras, options.frames);
  const FrameTimes& times = pictures.times;

  const Camera& first = views.cameras.front();
  const gl::Capabilities& device = context.capabilities();
  say_list("Reading " + options.scene.path + ":", scene.info.notes);
  say_list("Cameras:", views.notes);
  say_list("Plan:", plan_sentences(checked));
  say(fmt::format("{} triangles, {} on the device; {} x {} on {} ({})",
                  counted(soup.triangles.size()), bytes_text(renderer.device_bytes()), first.width,
                  first.height, device.renderer, context.description()));
  say(fmt::format("{:.2f} ms a frame (median of {}, 95 % within {:.2f} ms)", times.median(),
                  times.ms.size(), times.p95()));
  say_written(pictures, views);
  if (options.json)
    print_json(
        {{"width", first.width},
         {"height", first.height},
         {"context", context.description()},
         {"renderer", device.renderer},
         {"triangles", soup.triangles.size()},
         {"frame_ms", {{"median", times.median()}, {"p95", times.p95()}, {"n", times.ms.size()}}},
         {"plan", plan_sentences(checked)},
         {"output", pictures.paths}});
  return ExitCode::done;
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("render", "Pictures of a scene");
  command->footer(
      R"(Without a view the scene's first camera draws, or else a view from the front, a little to
the right and from above, that shows all of the scene.

Examples:
  tureen render soup.glb -o picture.png
  tureen render soup.glb --orbit 8 -o orbit_%02d.png      and a contact_sheet.png
  tureen render soup.glb --eye 3,0,1 --target 0,0,0.5 --up 0,0,1 --fov 35
  tureen render soup.glb --camera transforms.json:12 --size 540x960
  tureen render soup.glb --turntable 8 -o turn.mp4        a video, where ffmpeg is installed
  tureen render soup.glb --path path.json --fps 25 -o frame_%04d.png
                                                          the frames along a camera path
  tureen render soup.glb --supersample 4 -o smooth.png    16 samples a pixel
  tureen render soup.glb --frames 100 --json              milliseconds a frame
  tureen render soup.glb --pipeline published --frames 100 --json
                                                          against the baseline

Exit codes: 0 done, 2 wrong usage, 3 the scene cannot be read, 4 no OpenGL context,
5 it does not fit on the device or cannot be written.)");
  add_scene_argument(*command, options->scene);
  command
      ->add_option(
          "-o,--output", options->output,
          "the picture, out.png by default; of several views %d becomes the number; a name "
          "that ends in .mp4 or .webm is a video of --path or --turntable, by ffmpeg")
      ->option_text("OUT.png");
  add_view_options(*command, options->views);
  command
      ->add_option("--background", options->background,
                   "what pixels without a triangle show: white, black, transparent, or r,g,b from "
                   "0 to 1; the scene's own by default")
      ->option_text("COLOR");
  add_drawing_options(*command, options->drawing);
  add_drawing_scale(*command, options->drawing);
  command
      ->add_option("--frames", options->frames,
                   "draw so many frames more, after a warm-up, and tell the time of each")
      ->check(CLI::Range(1, 1000000))
      ->option_text("N");
  command->add_flag("--json", options->json,
                    "what was drawn, and how fast, as JSON on standard output");
  command->callback([options, &action] { action = [options] { return render(*options); }; });
}

}  // namespace tureen::cli
