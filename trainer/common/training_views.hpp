// A dataset as a trainer takes it: pictures without alpha, and lengths in the dataset's own units.
#pragma once

#include <vector>

#include "formats/dataset/dataset.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// The photograph over config.background, rounded to the nearest byte; every pixel counts.
TrainingView training_view(const Photograph& photograph, const Config& config);

/// All of them, in their order. Takes the pictures: what stays in `photographs` are cameras, so
/// that no picture is in memory twice.
std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              const Config& config);

/// The configuration with its lengths of training (vertex_rate, near, far: see reference_extent) in
/// the units of a dataset whose region of interest has this half side.
Config scaled_to(const Config& config, double half_side);

}  // namespace tureen::trainer
