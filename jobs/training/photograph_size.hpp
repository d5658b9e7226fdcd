// The size of the photographs for a training of given time. Larger photographs have more detail,
// but a step takes longer: with too few steps, the scene stays blurred, whatever their size.
#pragma once

#include "jobs/training/training_method.hpp"

namespace tureen {

struct TimeForSteps {
  double seconds = 0;            // of the training
  double pixels = 0;             // of a photograph at full size
  int shorter_side = 0;          // of the smallest photograph, in pixels
  double seconds_per_pixel = 0;  // of a step
  int steps = 0;                 // wanted, at least
};

/// The largest of 1, 1/2, 1/4 and 1/8 at which the time allows the steps; if none does, the
/// smallest at which the shorter side has at least 100 pixels (and 1, if that has less).
double scale_for(const TimeForSteps& time);

/// The time that this machine needs for a step of Gaussians, for each pixel: the median of some
/// steps on small images of noise. Takes less than a second.
double measured_seconds_per_pixel(int threads);

struct PhotographSize {
  double scale = 1;
  OwnFact note;  // for RunPlan::notes
};

/// The size for a training by this method. `full`: cameras of the training photographs at full
/// size, at least one.
PhotographSize photographs_for(double minutes, const std::vector<Camera>& full,
                               const TrainingMethodInfo& method, double seconds_per_pixel);

}  // namespace tureen
