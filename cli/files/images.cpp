#include "cli/files/images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "base/output.hpp"
#include "base/steady_seconds.hpp"
#include "cli/files/image_file.hpp"
#include "cli/progress.hpp"
#include "image/contact_sheet.hpp"
#include "image/png_rows.hpp"
#include "image/video_file.hpp"

namespace tureen::cli {

namespace {

double timed_draw(
    const Drawer& drawer, const FrameInput& input,
    const std::function<void(double)>& progress = [](double) {}) {
  const double start = steady_seconds();
  drawer.draw(input, progress);
  return 1000 * (steady_seconds() - start);
}

bool needs_tiles(const Quality& quality, const gl::Capabilities& device, const Camera& camera) {
  if (quality.resolution_scale < 1) return false;              // tiles do not support it
  constexpr std::int64_t max_samples = std::int64_t(1) << 26;  // 1 GiB of targets
  const std::int64_t columns = std::int64_t(camera.width) * quality.supersampling;
  const std::int64_t rows = std::int64_t(camera.height) * quality.supersampling;
  return std::max(columns, rows) > device.max_image_side || columns * rows > max_samples;
}

/// Progress of drawing; slow renderers, which do not warm up, show the time that is left.
class SlowProgress {
 public:
  explicit SlowProgress(const Drawer& drawer) : is_slow_(!drawer.warms_up) {}

  void update(double fraction) {
    progress_.update(fraction, is_slow_ ? time_left_text(fraction, steady_seconds() - start_) : "");
  }

 private:
  bool is_slow_;
  double start_ = steady_seconds();
  Progress progress_{"drawing"};
};

/// The same view at the size of a thumbnail.
Camera small_view(const Camera& camera) {
  constexpr int cell = 320;  // the default of contact_sheet()
  const double scale = std::min(1.0, double(cell) / std::max(camera.width, camera.height));
  const auto side = [&](int s) { return std::max(1, int(std::lround(s * scale))); };
  return resampled(camera, side(camera.width), side(camera.height));
}

/// Draws an image at once and writes it. Returns its thumbnail.
Image8 draw_whole(const Drawer& drawer, const Camera& camera, const std::filesystem::path& path,
                  std::vector<double>& ms, const std::function<void(double)>& progress) {
  ms.push_back(timed_draw(drawer, {camera}, progress));
  const Image8 image = drawer.read();
  write_image(image, path);
  return thumbnail(image);
}

/// Draws an image in tiles and writes it row by row, in about 400 MiB for any size. Returns its
/// thumbnail.
Image8 draw_large(const Drawer& drawer, const Camera& camera, const std::filesystem::path& path,
                  std::vector<double>& ms, const std::function<void(double)>& progress) {
  ms.push_back(0);
  ImageTiles tiles = drawer.tiles();
  tiles.draw = [&](const FrameInput& part) {
    ms.back() += timed_draw(drawer, part);
    return drawer.read();
  };
  tiles.progress = progress;
  Output output(path);
  PngRows rows(output, camera.width, camera.height);
  draw_in_bands({camera}, tiles, [&](const Image8& band) { rows.append(band); });
  rows.finish();
  output.commit();
  timed_draw(drawer, {small_view(camera)});
  return drawer.read();
}

}  // namespace

Drawer drawer_of(Renderer& renderer, const gl::Capabilities& device) {
  return {.draw =
              [&renderer](const FrameInput& input, const auto&) {
                renderer.draw(input);
                renderer.finish();
              },
          .read = [&renderer] { return renderer.read_color(); },
          .tiles = [&renderer, &device] { return tiles_of(renderer, device); },
          .needs_tiles =
              [&renderer, &device](const Camera& camera) {
                return needs_tiles(renderer.plan().quality, device, camera);
              }};
}

Drawer drawer_of(ImageSource& source, std::function<void(double)>& progress, bool opaque) {
  auto last = std::make_shared<Image8>();
  return {.draw =
              [&source, &progress, opaque, last](const FrameInput& input,
                                                 const std::function<void(double)>& each) {
                progress = each;
                *last = source.image(input);
                if (opaque)
                  for (glm::u8vec4& pixel : last->pixels) pixel.a = 255;
              },
          .read = [last] { return *last; },
          .tiles = {},
          .needs_tiles = [](const Camera&) { return false; },
          .warms_up = false};
}

std::filesystem::path contact_sheet_name(const std::string& pattern) {
  return image_name(pattern, 0, 2).replace_filename("contact_sheet.png");
}

WrittenImages draw_images(const Drawer& drawer, const std::vector<Camera>& cameras,
                          const ImageNames& names) {
  const bool with_sheet = cameras.size() > 1 && names.sheet == Sheet::of_several;
  const int count = int(cameras.size());
  WrittenImages result;
  std::vector<Image8> thumbnails;
  SlowProgress progress(drawer);
  // For an image without tiles, this also creates the targets.
  const Camera& first = cameras.front();
  if (drawer.warms_up) timed_draw(drawer, {drawer.needs_tiles(first) ? small_view(first) : first});
  for (int i = 0; i < count; ++i) {
    const auto update = [&](double done) { progress.update((i + done) / count); };
    update(0);
    const Camera& camera = cameras[std::size_t(i)];
    const std::filesystem::path path = image_name(names.pattern, i, count);
    Image8 small = drawer.needs_tiles(camera) ? draw_large(drawer, camera, path, result.ms, update)
                                              : draw_whole(drawer, camera, path, result.ms, update);
    if (with_sheet) thumbnails.push_back(std::move(small));
    result.paths.push_back(path.string());
    update(1);  // reports an interrupt, after which a renderer may have kept a part of the image
  }
  if (with_sheet) {
    const std::filesystem::path sheet = contact_sheet_name(names.pattern);
    write_image(contact_sheet(thumbnails), sheet);
    result.paths.push_back(sheet.string());
  }
  return result;
}

WrittenImages draw_video(const Drawer& drawer, const std::vector<Camera>& cameras,
                         double frames_per_second, const std::string& path) {
  const Camera& first = cameras.front();
  WrittenImages result{{path}, {}};
  VideoFile video(path, {first.width, first.height, frames_per_second});
  SlowProgress progress(drawer);
  if (drawer.warms_up) timed_draw(drawer, {first});
  for (const Camera& camera : cameras) {
    const auto update = [&](double done) {
      progress.update((double(result.ms.size()) + done) / double(cameras.size()));
    };
    update(0);
    result.ms.push_back(timed_draw(drawer, {camera}, update));
    video.add(drawer.read());
  }
  video.commit();
  return result;
}

std::vector<double> benchmark(const Drawer& drawer, const std::vector<Camera>& cameras,
                              int frames) {
  for (const Camera& camera : cameras)
    if (drawer.needs_tiles(camera))
      throw UsageError(
          fmt::format("--frames cannot measure {} x {}: images of this size are drawn in tiles; "
                      "use a smaller --size",
                      camera.width, camera.height));
  const int warm_up = std::clamp(frames, 3, 10);
  Progress progress("timing");
  std::vector<double> times;
  for (int i = -warm_up; i < frames; ++i) {
    const double ms = timed_draw(drawer, {cameras[std::size_t(i + warm_up) % cameras.size()]});
    if (i >= 0) times.push_back(ms);
    progress.update(double(i + warm_up + 1) / (frames + warm_up));
  }
  return times;
}

}  // namespace tureen::cli
