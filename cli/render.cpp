// `tureen render`: images of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/files/image_file.hpp"
#include "cli/files/images.hpp"
#include "cli/files/measured_images.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/debug_view_option.hpp"
#include "cli/options/drawing_options.hpp"
#include "cli/options/material_option.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/renderer_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/options/view_options.hpp"
#include "cli/report.hpp"
#include "image/video_file.hpp"
#include "jobs/bench/plan_json.hpp"
#include "jobs/timing/frame_statistics.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer.hpp"

namespace tureen::cli {

namespace {

struct RenderOptions {
  SceneArguments scene;
  RendererChoice renderer;
  ViewOptions views;
  std::string output = "out.png";
  std::string background;  // empty: the scene's own
  DrawingOptions drawing;
  DebugViewOption show;
  MaterialChoices materials;
  MeasuredOutputs measured;
  int frames = 0;
  bool force = false;
  bool verbose = false;
  bool json = false;
};

/// The written images and the text to print about them.
struct Drawn {
  WrittenImages images;
  std::vector<std::string> plan;
  std::vector<AppliedSpecialisation> specialisations;
  std::vector<std::string> legend;  // of debug views
  std::size_t device_bytes = 0;
};

/// An animation has hundreds of similar frames, for which a contact sheet is useless.
bool has_sheet(int count, const Views& views) { return count > 1 && views.frames_per_second == 0; }

/// Images, or an animation.
WrittenImages draw_views(const Drawer& drawer, const Views& views, const std::string& output) {
  if (is_video_name(output))
    return draw_video(drawer, views.cameras, views.frames_per_second, output);
  const Sheet sheet = has_sheet(int(views.cameras.size()), views) ? Sheet::of_several : Sheet::none;
  return draw_images(drawer, views.cameras, {output, sheet});
}

Drawn draw_colors(const gl::Context& context, const Scene& scene, const RenderOptions& options,
                  glm::vec4 background, const Views& views) {
  const gl::Capabilities& device = context.capabilities();
  Renderer renderer =
      make_renderer(context, scene, options.drawing.pipeline,
                    {.plan = preferences_for(scene, options.drawing), .background = background});
  const Drawer drawer = drawer_of(renderer, device);
  // benchmark() rejects images in tiles. It runs first, because drawing may take hours.
  std::vector<double> ms;
  if (options.frames > 0) ms = benchmark(drawer, views.cameras, options.frames);
  WrittenImages images = draw_views(drawer, views, options.output);
  if (options.frames > 0) images.ms = std::move(ms);
  const RenderPlan& plan = renderer.plan();
  return {std::move(images), describe(plan), plan.applied(), {}, renderer.device_bytes()};
}

Drawn draw_debug_view(const gl::Context& context, const Scene& scene, const RenderOptions& options,
                      glm::vec4 background, const Views& views) {
  const gl::Capabilities& device = context.capabilities();
  const std::vector<PlacedLayer> layers = placed_layers(scene);
  DebugViews debug_views(layers);
  Renderer renderer(context, prepare_debug_views(layers, device_limits(device)),
                    {.background = background});
  debug_views.show(renderer, options.show.what, options.show.features);
  WrittenImages images = draw_views(drawer_of(renderer, device), views, options.output);
  const std::string sentence =
      std::string("debug view: ") + name_of(options.show.what) +
      " with one sample per pixel, without specialisations that can change a colour";
  return {std::move(images),
          {sentence},
          {},
          legend_lines(debug_views.legend()),
          renderer.device_bytes()};
}

/// Throws UsageError for what the renderer does not support.
WrittenImages draw_without_gl(const Scene& scene, const RenderOptions& options,
                              const glm::vec4& background, const Views& views) {
  const bool opaque = background.a >= 1;
  std::function<void(double)> progress = [](double) {};
  const std::unique_ptr<ImageSource> images = options.renderer.renderer->make(
      scene, {.quality = preferences_for(scene, options.drawing).quality,
              .background = opaque ? std::optional(glm::vec3(background)) : std::nullopt,
              .progress = [&](double done) { progress(done); },
              .samples = options.renderer.samples});
  return draw_views(drawer_of(*images, progress, opaque), views, options.output);
}

/// Throws UsageError if the scene has no such debug view. Runs before the context is created.
void require_shown(const DebugViewOption& show, const Scene& scene) {
  if (show.what == DebugView::color) return;
  try {
    DebugViews(placed_layers(scene)).require(show.what, show.features);
  } catch (const UsageError& error) {
    throw UsageError(std::string("--debug-view ") + name_of(show.what) + ": " + error.reason());
  }
}

/// Prints a sentence for each option of the scene that changes nothing in the images.
void say_what_has_no_effect(const RenderOptions& options, const Scene& scene) {
  if (!options.materials.empty() && options.renderer.renderer != ray_renderer().renderer)
    say("--material has no effect: only --renderer trace draws mirrors and glass");
  // Further scenes are turned to the up axis of the first.
  if (!options.scene.choice.up.empty() && options.scene.paths.size() == 1 &&
      !options.views.depends_on_up(scene))
    say("--up has no effect: the cameras are recorded, with their own up axis");
}

/// Throws UsageError if a file exists. An image of another scene or view may be the only one.
void require_new(const std::filesystem::path& path, const RenderOptions& options,
                 const char* way_out = "choose another name") {
  std::error_code unknown;
  if (!options.force && std::filesystem::exists(path, unknown))
    throw UsageError(path.string() + " exists",
                     std::string(way_out) + ", or replace it with --force");
}

/// The same for all images of a run, once their number is known.
void require_new_images(const RenderOptions& options, const Views& views) {
  const int count = int(views.cameras.size());
  std::vector<std::string> patterns{options.output};
  for (const MeasuredOutput& each : options.measured.list) patterns.push_back(each.pattern);
  for (const std::string& pattern : patterns)
    for (int i = 0; i < count && !pattern.empty() && !is_video_name(pattern); ++i)
      require_new(image_name(pattern, i, count), options);
  if (has_sheet(count, views) && !is_video_name(options.output))
    require_new(contact_sheet_name(options.output), options, "choose another folder");
}

/// Throws UsageError and OutputError for the names of one image for each view.
void check_images(const std::string& pattern, const RenderOptions& options) {
  const int count = std::max(options.views.orbit, 1);
  for (int i = 0; i < count; ++i) require_not_inputs(image_name(pattern, i, count), options.scene);
  const std::filesystem::path first = image_name(pattern, 0, count);
  // The number of views in a camera file or an animation, and so the names of the images, are not
  // known yet.
  if (options.views.is_animation() || !options.views.camera.empty())
    require_writable_beside(first);
  else
    require_writable_file(first);
  require_new(first, options);
}

/// Throws UsageError and OutputError.
void check_output(const RenderOptions& options, const glm::vec4& background) {
  require_measured_names(options.measured, options.output);
  for (const MeasuredOutput& each : options.measured.list)
    if (!each.pattern.empty()) check_images(each.pattern, options);
  if (!is_video_name(options.output)) {
    require_png_name(options.output);
    check_images(options.output, options);
    return;
  }
  if (!options.views.is_animation())
    throw UsageError("'" + options.output + "' is a video; videos need --path or --turntable");
  if (!options.background.empty() && background.a < 1)
    throw UsageError("videos do not support transparency",
                     "remove --background transparent, or write images with -o frame_%04d.png");
  if (!have_ffmpeg()) throw UsageError(ffmpeg_missing, ffmpeg_hint);
  require_not_inputs(options.output, options.scene);
  require_writable_file(options.output);
  require_new(options.output, options);
}

/// Prints the files and the scales of depths.
void say_measured(const std::vector<MeasuredImage>& images) {
  for (const MeasuredImage& image : images) {
    say("wrote " + image.path);
    if (image.far > 0)
      say(fmt::format("  depth = {:.9g} + (value - 1) / 65534 * {:.9g}; 0 where nothing is visible",
                      image.near, image.far - image.near));
  }
}

Json measured_json(const std::vector<MeasuredImage>& images) {
  Json list = Json::array();
  for (const MeasuredImage& image : images) {
    list.push_back({{"path", image.path}, {"value", name_of(image.what)}});
    if (image.far > 0) list.back().update({{"near", image.near}, {"far", image.far}});
  }
  return list;
}

Json frame_ms_json(const std::vector<double>& ms) {
  return {{"median", median(ms)}, {"p95", percentile(ms, 95)}, {"n", ms.size()}};
}

/// Prints the written files: all names, or the first and the last frame.
void say_written(const WrittenImages& images, const Views& views) {
  const std::vector<std::string>& paths = images.paths;
  if (views.frames_per_second > 0)
    say(fmt::format("{} frames, {:.2f} s at {:g} frames per second", views.cameras.size(),
                    double(views.cameras.size()) / views.frames_per_second,
                    views.frames_per_second));
  if (views.frames_per_second > 0 && paths.size() > 2) {
    say("wrote " + paths.front() + " to " + paths.back());
    return;
  }
  if (views.frames_per_second > 0 && paths.size() == 1) return say("wrote " + paths.front());
  for (std::size_t i = 0; i < paths.size(); ++i)
    say("wrote " + paths[i] +
        (i < views.cameras.size() && i < images.ms.size()
             ? fmt::format(", {} x {}, drawn in {:.3g} s", views.cameras[i].width,
                           views.cameras[i].height, images.ms[i] / 1000)
             : ""));
}

ExitCode render(RenderOptions options) {
  // Wrong arguments are reported before the scene is read.
  check(options.views);
  glm::vec4 background(0.0f);
  if (!options.background.empty()) background = parse_background(options.background);
  check_output(options, background);

  Scene scene = read(options.scene);
  apply_materials(options.materials, scene);
  apply_opaque(scene, options.drawing);
  const Views views = resolve_views(options.views, scene, options.scene.paths.front());
  if (options.background.empty()) background = glm::vec4(scene.info.background, 1.0f);
  require_shown(options.show, scene);
  require_new_images(options, views);
  say_what_has_no_effect(options, scene);
  const Camera& first = views.cameras.front();
  if (const ProcessorRenderer* renderer = options.renderer.renderer) {
    const WrittenImages images = draw_without_gl(scene, options, background, views);
    say_list("Reading " + listed(options.scene) + ":", notes_of(scene.info));
    say_what_is_hidden(scene);
    say_list("Cameras:", views.notes);
    if (options.verbose)
      say(fmt::format("{}; {} x {} by {}; {:.2f} s per image",
                      primitives_text(triangle_count(scene), splat_count(scene)), first.width,
                      first.height, renderer->name, median(images.ms) / 1000));
    say_written(images, views);
    if (options.json)
      print_json({{"width", first.width},
                  {"height", first.height},
                  {"renderer", renderer->name},
                  {"triangles", triangle_count(scene)},
                  {"splats", splat_count(scene)},
                  {"frame_ms", frame_ms_json(images.ms)},
                  {"output", images.paths}});
    return ExitCode::done;
  }

  const gl::Context context = gl::Context::create({.backend = options.drawing.backend});
  throw_if_interrupted();
  require_measured_sizes(context.capabilities(), views.cameras, options.measured);
  const auto draw = options.show.what == DebugView::color ? draw_colors : draw_debug_view;
  const Drawn drawn = draw(context, scene, options, background, views);
  const std::vector<MeasuredImage> measured =
      options.measured.any() ? write_measured(context, scene, views.cameras, options.measured)
                             : std::vector<MeasuredImage>{};
  const WrittenImages& images = drawn.images;
  const double median_ms = median(images.ms), p95_ms = percentile(images.ms, 95);

  const gl::Capabilities& device = context.capabilities();
  say_list("Reading " + listed(options.scene) + ":", notes_of(scene.info));
  say_what_is_hidden(scene);
  say_list("Cameras:", views.notes);
  if (options.verbose) say_list("Plan:", drawn.plan);
  say_list(std::string("Legend of ") + name_of(options.show.what) + ":", drawn.legend);
  if (options.verbose)
    say(fmt::format("{}, {} on the device; {} x {} on {} ({})",
                    primitives_text(triangle_count(scene), splat_count(scene)),
                    bytes_text(drawn.device_bytes), first.width, first.height, device.renderer,
                    context.description()));
  if (options.verbose || options.frames > 0)
    say(fmt::format("{:.2f} ms per frame (median of {}, 95 % within {:.2f} ms)", median_ms,
                    images.ms.size(), p95_ms));
  say_written(images, views);
  say_measured(measured);
  if (options.json) {
    Json json = {{"width", first.width},
                 {"height", first.height},
                 {"context", context.description()},
                 {"renderer", device.renderer},
                 {"software", device.software},
                 {"triangles", triangle_count(scene)},
                 {"splats", splat_count(scene)},
                 {"frame_ms", frame_ms_json(images.ms)},
                 {"plan", drawn.plan},
                 {"specialisations", results::specialisations_json(drawn.specialisations)},
                 {"output", images.paths}};
    if (!measured.empty()) json["measured"] = measured_json(measured);
    print_json(json);
  }
  return ExitCode::done;
}

void add_options(Command& command, const std::shared_ptr<RenderOptions>& options) {
  add_scene_arguments(command, options->scene);
  add_placing_options(command, options->scene.choice);
  add_memory_option(command);
  command.add_option(
      "-o,--output OUT.png", options->output,
      "image to write, out.png by default; with several views, %d is the index of the view; with "
      "--path or --turntable, .mp4 or .webm writes a video with ffmpeg");
  add_view_options(command, options->views);
  command.add_option("--background COLOR", options->background,
                     "colour behind the scene: a name, #rrggbb, transparent, or r,g,b from 0 to 1; "
                     "the scene's own by default");
  add_material_option(command, options->materials);
}

/// `check` throws UsageError for options that exclude each other.
void finish(Command& command, const std::shared_ptr<RenderOptions>& options,
            const std::function<void()>& check) {
  command.add_flag("--json", options->json,
                   "print the images, the plan and the frame times as JSON to standard output");
  command.add_flag("--verbose", options->verbose,
                   "also print the plan, the device and the frame time");
  command.add_flag("--force", options->force, "replace existing images");
  command.does([options, check] {
    check();
    return render(*options);
  });
}

void add_gl_options(Command& command, const std::shared_ptr<RenderOptions>& options) {
  add_drawing_options(command, options->drawing);
  add_drawing_scale(command, options->drawing);
  command.add_flag(
      "--as-published", options->drawing.plan.as_published,
      "also apply the culling rules in the authors' code that depend on the resolution");
  add_measured_outputs(command, options->measured);
  Option show = add_debug_view_option(command, options->show);
  for (const char* other :
       {"--supersample", "--scale", "--pipeline", "--shading", "--no-specialise", "--keep"})
    show.excludes(command.option(other));
  command
      .add_option("--frames N", options->frames,
                  "after a warm-up, draw N more frames and print their times", between(1, 1000000))
      .excludes(show);
}

}  // namespace

void add_render(Command& program) {
  Command command = program.add_command("render", "Draw images of a scene");
  command.footer(
      R"(The default view is the first view stored in the scene (convert --view), otherwise the recorded
camera that looks most directly at the point that the cameras look at, from their usual distance and
height. Without cameras, it shows the whole scene from the front, slightly from the right and above.
Orbits and turntables of captured places circle that point, among the cameras.

Examples:
  tureen render soup.glb -o image.png
  tureen render house.glb fox.glb -o both.png             several scenes in one image
  tureen render table.glb guitar.ply -o both.png --place guitar=at:0,0,1.2/scale:0.5
                                                          one layer moved and scaled down
  tureen render soup.glb --orbit 8 -o orbit_%02d.png      also writes contact_sheet.png
  tureen render soup.glb --eye 3,0,1 --target 0,0,0.5 --up 0,0,1 --fov 35
  tureen render soup.glb --camera transforms.json:12 --size 540x960
  tureen render soup.glb --turntable 8 -o turn.mp4        a video; needs ffmpeg
  tureen render soup.glb --path cameras -o flight.mp4     along the recorded cameras
  tureen render soup.glb --path path.json --fps 25 -o frame_%04d.png
                                                          the frames along a camera path
  tureen render soup.glb --supersample 4 -o smooth.png    16 samples per pixel
  tureen render soup.glb --size 40000x20000 -o poster.png beyond the device's limit: in tiles
  tureen render soup.glb --renderer oracle -o exact.png   in double precision, without OpenGL
  tureen render soup.glb --renderer trace -o rays.png     mirrors and glass; also: tureen trace
  tureen render soup.glb --debug-view depth -o depth.png  or normals, texels, overdraw, ..
  tureen render soup.glb --depth depth.exr --alpha a.png  also values: 32-bit floats or 16 bits
  tureen render soup.glb --frames 100 --json              milliseconds per frame
  tureen render soup.glb --pipeline baseline --frames 100 --json
                                                          the same for the baseline

Exit codes: 0 done, 2 wrong usage, 3 the scene cannot be read, 4 no OpenGL context,
5 the scene does not fit on the device, or an image cannot be written.)");
  const auto options = std::make_shared<RenderOptions>();
  add_options(command, options);
  add_gl_options(command, options);
  finish(command, options, add_renderer_option(command, options->renderer));
}

void add_trace(Command& program) {
  Command command = program.add_command("trace", "Ray-trace images, with mirrors and glass");
  command.footer(
      R"(Short for tureen render --renderer trace, with the same options. Splats are blended in exact order
along each ray. Materials of meshes come from the file or from --material.

Examples:
  tureen trace scene.glb -o image.png
  tureen trace splats.ply ball.glb --samples 16 -o smooth.png   16 rays per pixel
  tureen trace scene.glb --turntable 4 -o turn.mp4              a video; needs ffmpeg

Ctrl-C keeps the finished images, and the finished samples of the current one.

Exit codes: 0 done, 2 wrong usage, 3 the scene cannot be read, 5 an image cannot be written.)");
  const auto options = std::make_shared<RenderOptions>();
  options->renderer = ray_renderer();
  add_options(command, options);
  add_sampling_options(command, options->drawing);
  add_samples_option(command, options->renderer);
  finish(command, options, [] {});
}

}  // namespace tureen::cli
