// The loss from storing splats in another format, measured in images.
#pragma once

#include <cstddef>
#include <functional>

#include "scene/scene.hpp"

namespace tureen {

/// Of the stored scene's images against those of the original, over 8-bit values.
struct ConversionLoss {
  std::size_t views = 0;
  double psnr_db = 0;        // of all views together; 100 if all images are equal
  double worst_psnr_db = 0;  // of one view
};

/// Whether both scenes have only splats, so that tiles draw them.
bool is_measurable(const Scene& scene);

/// Draws 16 survey_views() of `before` of both scenes on the processor, of at most 800 pixels a
/// side. `progress` gets the fraction done and may throw to cancel. Throws the errors of drawing.
ConversionLoss conversion_loss(const Scene& before, const Scene& after,
                               const std::function<void(double)>& progress);

}  // namespace tureen
