#include "oracle/oracle_images.hpp"

#include <algorithm>
#include <cassert>
#include <thread>
#include <utility>

#include "base/threads/on_all_cores.hpp"

namespace tureen {

namespace {

/// Each strip projects all splats, so there are few; but more than cores, because strips differ.
constexpr int strips_per_core = 4;
/// Keeps the memory of a strip below about 350 MB.
constexpr double rays_in_a_strip = 4e6;

/// The camera of rows [first, first + rows).
FrameInput strip_of(const FrameInput& input, int first, int rows) {
  FrameInput strip = input;
  if (!strip.whole) strip.whole = input.camera;
  strip.camera.height = rows;
  strip.camera.cy -= first;
  return strip;
}

/// Sets alpha to the mean coverage of a pixel's rays.
void set_coverage(OracleImage& image, int supersampling) {
  const auto width = std::size_t(image.color.width), n = std::size_t(supersampling);
  std::vector<double> covered(image.color.pixels.size());
  for (std::size_t ray = 0; ray < image.face.size(); ++ray) {
    const std::size_t column = ray % (width * n) / n, row = ray / (width * n) / n;
    const double of_splats = image.splat_alpha.empty() ? 0.0 : image.splat_alpha[ray];
    covered[row * width + column] += image.face[ray] != OracleImage::no_face ? 1.0 : of_splats;
  }
  for (std::size_t i = 0; i < covered.size(); ++i)
    image.color.pixels[i].a = float(covered[i] / double(n * n));
}

/// Draws rows [first, first + rows) of the image.
void draw_strip(const Scene& scene, const FrameInput& input, const OracleOptions& options,
                int first, int rows, ImageF& image) {
  OracleImage drawn = render_oracle(scene, strip_of(input, first, rows), options);
  if (options.background) set_coverage(drawn, options.supersampling);
  std::ranges::copy(drawn.color.pixels, &image.at(0, first));
}

}  // namespace

ImageF oracle_image(const Scene& scene, const FrameInput& input, OracleOptions options, int rows) {
  const Camera& camera = input.camera;
  const std::function<void(double)> progress = std::move(options.progress);
  ImageF image(camera.width, camera.height);
  for (int first = 0; first < camera.height; first += rows) {
    const int height = std::min(rows, camera.height - first);
    if (progress)
      options.progress = [&](double fraction) {
        progress((first + fraction * height) / camera.height);
      };
    draw_strip(scene, input, options, first, height, image);
  }
  return image;
}

std::optional<ImageF> OracleImages::exact_image(const FrameInput& input) {
  assert(options_.rays.coverage == oracle::Coverage::exact);
  const Camera& camera = input.camera;
  const int n = options_.supersampling;
  const int strips = strips_per_core * int(std::max(1u, std::thread::hardware_concurrency()));
  const int most = int(rays_in_a_strip / (n * n) / camera.width);
  const int rows = std::clamp((camera.height + strips - 1) / strips, 1, std::max(1, most));
  ImageF image(camera.width, camera.height);
  const auto count = std::size_t((camera.height + rows - 1) / rows);
  const auto progress = [&](double done) {
    if (options_.progress) options_.progress(done);
  };
  on_all_cores(count, progress, [&](std::size_t i, const auto& check) {
    OracleOptions options = options_;
    options.progress = check;
    const int first = int(i) * rows;
    draw_strip(scene_, input, options, first, std::min(rows, camera.height - first), image);
  });
  return image;
}

}  // namespace tureen
