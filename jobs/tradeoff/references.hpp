// Reference images for errors of drawing, by the oracle or by rays: one model; and the errors.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "image/render_error.hpp"
#include "oracle/oracle.hpp"

namespace tureen::tradeoff {

/// The sample points of the reference, and the order of its splats. All kinds use float colours of
/// unquantised texels.
enum class Samples {
  /// One sample per pixel; splats in the order of their centres, triangles at the device's sample
  /// points: vertices lie on its subpixel grid
  /// (oracle::Coverage::snapped). The device's rounding is independent of all settings, but on
  /// small images it costs more than most of them (docs/tradeoff.md).
  device,
  /// One sample per pixel, at its centre, of the exact triangles; splats in exact order.
  exact,
  /// The same by rays (tracing/): splats in single precision, an error below 1/255 at 99.9 % of the
  /// pixels, in a small part of the time.
  traced,
  /// antialiased_samples^2 samples per pixel, on a regular grid, of the exact triangles; splats in
  /// the order of their centres.
  antialiased,
};

/// Samples a pixel and axis of Samples::antialiased. Supersampling with the same number uses the
/// same points: its difference from the reference is only rounding.
inline constexpr int antialiased_samples = 8;

/// GL_SUBPIXEL_BITS of the current context: the precision of vertices within a pixel. Returns 8,
/// the most common value, if the reported value is outside the oracle's range 1 .. 16.
int device_subpixel_bits();

struct ReferenceOptions {
  Samples samples = Samples::device;
  int subpixel_bits = 8;  // of the device, for Samples::device: device_subpixel_bits()
  glm::vec3 background{0.0f};
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

/// One image per camera over the background, drawn on all cores. Rethrows exceptions from
/// options.progress with a short delay.
std::vector<ImageF> reference_images(const Scene& scene, std::span<const Camera> cameras,
                                     const ReferenceOptions& options);

/// The images rounded to 8 bits a channel, as on a screen.
std::vector<ImageF> as_shown(std::span<const ImageF> images);

/// The error over all images; both spans have the same length.
RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip);

}  // namespace tureen::tradeoff
