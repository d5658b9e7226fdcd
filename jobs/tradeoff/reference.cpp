#include "jobs/tradeoff/reference.hpp"

#include <algorithm>
#include <utility>

#include "oracle/oracle_images.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::tradeoff {

namespace {

constexpr double rays_in_a_strip = 4e6;

}  // namespace

int device_subpixel_bits() {
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return bits >= 1 && bits <= 16 ? bits : 8;
}

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

}  // namespace tureen::tradeoff
