// Blends all splats of a scene over its opaque surfaces, front to back, in double precision.
//
// Each sample has a colour and a transmittance, at first 0 and 1. A splat of alpha a adds a *
// transmittance * its colour, and the transmittance is multiplied by 1 - a. The profile of a
// splat's own layer decides its alpha limits, whether it ends the sample
// (SplatProfile::stop_transmittance), and how near its centre may be
// (SplatProfile::min_center_depth).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "oracle/splat_view.hpp"
#include "scene/camera.hpp"
#include "scene/placed_layer.hpp"

namespace tureen::oracle {

/// Which splat is in front of another. Ties go to the earlier layer, then to the lower index.
enum class SplatOrder {
  /// By the view depth of the centres, over all layers: the order of the authors' renderers, and
  /// ours.
  center,
  /// At each sample by depth along its ray: of a window or disc, the depth of its plane; of a
  /// Gaussian by EWA, the depth of its largest density; of a neural density, the middle of its
  /// chord.
  exact,
};

struct SplatBlending {
  SplatOrder order = SplatOrder::center;
  bool stop = true;  // false: stop_transmittance is ignored
  /// Samples per pixel along each axis. Low passes are in pixels, whatever the number of samples.
  int supersampling = 1;
  double near = 0;  // of the frame's clip range
  SplatCulls culls = SplatCulls::none;
  std::optional<Camera> whole = {};  // of the whole image, if the camera is that of a part
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

/// The splats at one sample.
struct BlendedSample {
  glm::dvec3 color{0.0};  // premultiplied: the sum over the splats
  double transmittance = 1;
  /// The depth of the splat at which the transmittance falls to 0.5 or below; infinity if it stays
  /// above.
  double median_depth = std::numeric_limits<double>::infinity();
  bool ended = false;  // no further splat is blended
};

/// Blends the splats of `layers`, which have no defect() and may include hidden layers. Returns all
/// samples, row by row from the top; a row has width * supersampling samples. Only splats in front
/// of the opaque surface count: `opaque_depth` is its depth for each sample, or infinity. Needs
/// memory for the result and a few numbers per splat; SplatOrder::exact also for the splats at the
/// samples of a band of rows.
std::vector<BlendedSample> blend(std::span<const PlacedLayer> layers, const Camera& camera,
                                 std::span<const double> opaque_depth,
                                 const SplatBlending& options);

}  // namespace tureen::oracle
