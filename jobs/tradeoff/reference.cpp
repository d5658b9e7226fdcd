#include "jobs/tradeoff/reference.hpp"

#include <algorithm>

namespace tureen::tradeoff {

namespace {

constexpr double rays_in_a_strip = 4e6;

/// The camera of rows [first, first + rows).
Camera strip_of(const Camera& camera, int first, int rows) {
  Camera strip = camera;
  strip.height = rows;
  strip.cy -= first;
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

}  // namespace

int device_subpixel_bits() {
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return bits >= 1 && bits <= 16 ? bits : 8;
}

ImageF reference_image(const Scene& scene, const Camera& camera, const ReferenceOptions& options) {
  const bool antialiased = options.samples == Samples::antialiased;
  const int n = antialiased ? antialiased_samples : 1;
  // A snapped image is drawn in one piece, because clipping depends on the image's border.
  const int rows = antialiased
                       ? std::clamp(int(rays_in_a_strip / (n * n) / camera.width), 1, camera.height)
                       : camera.height;
  OracleOptions oracle;
  oracle.supersampling = n;
  oracle.background = options.background;
  if (options.samples == Samples::exact) oracle.splat_order = oracle::SplatOrder::exact;
  if (options.samples == Samples::device) {
    oracle.rays.coverage = oracle::Coverage::snapped;
    oracle.rays.subpixel_bits = options.subpixel_bits;
  }
  ImageF image(camera.width, camera.height);
  for (int first = 0; first < camera.height; first += rows) {
    const Camera strip = strip_of(camera, first, std::min(rows, camera.height - first));
    if (options.progress)
      oracle.progress = [&](double fraction) {
        options.progress((first + fraction * strip.height) / camera.height);
      };
    OracleImage drawn = render_oracle(scene, {.camera = strip, .whole = camera}, oracle);
    set_coverage(drawn, n);
    std::copy(drawn.color.pixels.begin(), drawn.color.pixels.end(), &image.at(0, first));
  }
  return image;
}

}  // namespace tureen::tradeoff
