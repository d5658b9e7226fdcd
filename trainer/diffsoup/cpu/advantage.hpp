// The factor of the opacity's score at each pixel: its loss, relative to the mean loss of the same
// pixel in past steps.
#pragma once

#include <cstdint>

#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"

namespace tureen::trainer {

struct AdvantageInput {
  const TrainingView* view;
  float scale;          // of the factor
  float baseline_rate;  // of the running mean
  /// The running mean of each pixel's loss, encoded; 0 if there is none yet. Null: not subtracted.
  std::uint16_t* baseline;
};

/// Statistics of a band of rows.
struct BandReport {
  double squared = 0;  // sum of (C - G)^2 without ignored pixels
  std::uint64_t shaded = 0;
};

/// Replaces image.loss in rows [y0, y1) by the score's factor, and updates the running means.
BandReport take_advantage(BatchImage& image, const AdvantageInput& input, int y0, int y1);

}  // namespace tureen::trainer
