#include "jobs/tradeoff/references.hpp"

#include <algorithm>
#include <utility>

#include "base/threads/on_all_cores.hpp"
#include "oracle/oracle_images.hpp"
#include "runtime/gl/api.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::tradeoff {

namespace {

constexpr double rays_in_a_strip = 4e6;

/// oracle_image() over the background, in strips of at most about 4 million rays.
ImageF reference_image(const Scene& scene, const Camera& camera, const ReferenceOptions& options) {
  if (options.samples == Samples::traced)
    return *tracing::TracedImages(scene,
                                  {.background = options.background, .progress = options.progress})
                .exact_image({camera});
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
  oracle.progress = options.progress;
  return oracle_image(scene, {camera}, std::move(oracle), rows);
}

}  // namespace

int device_subpixel_bits() {
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return bits >= 1 && bits <= 16 ? bits : 8;
}

std::vector<ImageF> reference_images(const Scene& scene, std::span<const Camera> cameras,
                                     const ReferenceOptions& options) {
  std::vector<ImageF> images(cameras.size());
  on_all_cores(images.size(), options.progress, [&](std::size_t i, const auto& check) {
    ReferenceOptions of_one = options;
    of_one.progress = check;
    images[i] = reference_image(scene, cameras[i], of_one);
  });
  return images;
}

std::vector<ImageF> as_shown(std::span<const ImageF> images) {
  std::vector<ImageF> rounded;
  for (const ImageF& image : images) rounded.push_back(to_float(quantised(image)));
  return rounded;
}

RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip) {
  RenderErrorMeter meter({.with_flip = with_flip});
  for (std::size_t i = 0; i < reference.size(); ++i) meter.add(reference[i], drawn[i]);
  return meter.result();
}

}  // namespace tureen::tradeoff
