#include "viewer/writing.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/output.hpp"
#include "image/png.hpp"
#include "image/png_rows.hpp"
#include "image/video_file.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/image_tiles.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::viewer {

namespace {

/// Fraction of the progress bar for preparation.
constexpr double preparing_share = 0.05;

/// An hour at 240 frames a second has 864,000. More is probably a typing error.
constexpr int max_frames = 1000000;

/// Writes the rows that `draw` passes to its sink.
void write_rows(const ImageJob& job, const std::function<void(const BandSink&)>& draw) {
  Output output(job.path);
  PngRows rows(output, job.camera.width, job.camera.height);
  draw([&](const Image8& band) { rows.append(band); });
  rows.finish();
  output.commit();
}

/// Draws the frames in order and passes each to `take`.
void draw_frames(const AnimationJob& job, const StageRequest& request,
                 const std::function<void(const Image8&, std::size_t)>& take) {
  if (frame_count(job.path, job.rate.frames_per_second) > max_frames)
    throw UsageError("the animation has more than " + std::to_string(max_frames) + " frames");
  Renderer renderer = prepare_renderer(job.scene, request);
  const std::vector<Camera> cameras = frames(job.path, job.rate);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    renderer.draw({cameras[i]});
    take(renderer.read_color(), i);
    request.progress(preparing_share +
                     (1 - preparing_share) * double(i + 1) / double(cameras.size()));
  }
}

}  // namespace

namespace {

/// Tiles keep the memory small. `progress` takes the fraction done.
void write_traced_image(const ImageJob& job, const std::function<void(double)>& progress) {
  const glm::vec3 background = background_of(job.scene);
  tracing::TracedImages images(
      {.samples = job.rays,
       .background = job.transparent ? std::nullopt : std::optional(background)});
  std::map<LayerId, ProfiledSplats> profiled;
  images.report_to([&](double) { progress(0); });
  images.sync(layers_for_rays(job.scene, profiled));
  double fraction = 0;
  const double pixels = double(job.camera.width) * job.camera.height;
  const ImageTiles tiles{.draw =
                             [&](const FrameInput& input) {
                               const Camera& own = input.camera;
                               images.report_to([&](double done) {
                                 progress(fraction + done * own.width * own.height / pixels);
                               });
                               Image8 tile = images.image(input);
                               if (!job.transparent)
                                 for (glm::u8vec4& pixel : tile.pixels) pixel.a = 255;
                               return tile;
                             },
                         .side = 1024,
                         .progress = [&](double done) { progress(fraction = done); }};
  write_rows(job, [&](const BandSink& sink) { draw_in_bands({job.camera}, tiles, sink); });
}

}  // namespace

void write_image(const ImageJob& job, const StageRequest& request) {
  const glm::vec4 background(background_of(job.scene), job.transparent ? 0.0f : 1.0f);
  const auto progress = [&](double done) {
    request.progress(preparing_share + (1 - preparing_share) * done);
  };
  if (job.debug_view.what != DebugView::color) {
    const gl::Capabilities& device = request.context.capabilities();
    const std::vector<PlacedLayer> layers = placed_layers(job.scene.document.layers);
    DebugViews debug_views(layers);
    Renderer renderer(request.context, prepare_debug_views(layers, device_limits(device)),
                      {.background = background});
    debug_views.show(renderer, job.debug_view.what, job.debug_view.features);
    ImageTiles tiles = tiles_of(renderer, device);
    tiles.progress = progress;
    write_rows(job, [&](const BandSink& sink) { draw_in_bands({job.camera}, tiles, sink); });
    return;
  }
  if (job.rays > 0) return write_traced_image(job, progress);
  Renderer renderer = prepare_renderer(job.scene, request);
  renderer.set_background(background);
  if (renderer.plan().quality.resolution_scale < 1) {
    // Tiles of a lower resolution would not match at their borders, so the image is drawn whole.
    renderer.draw({job.camera});
    write_rows(job, [&](const BandSink& sink) { sink(renderer.read_color()); });
    return;
  }
  const gl::Capabilities& device = request.context.capabilities();
  double fraction = 0;  // a tile at rest may take long: progress() can end the job between frames
  ImageTiles tiles = job.at_rest ? tiles_at_rest(renderer, device, [&] { progress(fraction); })
                                 : tiles_of(renderer, device);
  tiles.progress = [&](double done) { progress(fraction = done); };
  write_rows(job, [&](const BandSink& sink) { draw_in_bands({job.camera}, tiles, sink); });
}

void write_animation(const AnimationJob& job, const StageRequest& request) {
  if (is_video_name(job.output)) {
    VideoFile video(job.output, {job.rate.width, job.rate.height, job.rate.frames_per_second});
    draw_frames(job, request, [&](const Image8& frame, std::size_t) { video.add(frame); });
    video.commit();
    return;
  }
  make_folder(job.output);
  draw_frames(job, request, [&](const Image8& frame, std::size_t i) {
    write_file(job.output / fmt::format("frame_{:04}.png", i), encode_png(frame));
  });
}

}  // namespace tureen::viewer
