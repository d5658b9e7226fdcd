// The size of the photographs for a training of given time. Larger photographs have more detail,
// but a step takes longer: with too few steps, the scene stays blurred, whatever their size.
#pragma once

#include <optional>
#include <span>

#include "formats/dataset/dataset.hpp"
#include "jobs/training/training_method.hpp"

namespace tureen {

struct TimeForSteps {
  double seconds = 0;            // of the training
  double pixels = 0;             // of a photograph at full size
  double seconds_per_pixel = 0;  // of a step
  int steps = 0;                 // wanted, at least

  /// The time of a step on photographs of this scale.
  double of_step(double scale) const;
};

/// The largest of 1, 1/2, 1/4 and 1/8 at which the time allows the steps; if none does, the
/// smallest at which a photograph has at least 30,000 pixels (and 1, if it has less at full size).
double scale_for(const TimeForSteps& time);

/// The time that this machine needs for a step of Gaussians, for each pixel: the median of some
/// steps on small images of noise. Takes less than a second.
double measured_seconds_per_pixel(int threads);

struct PhotographSize {
  double scale = 1;
  OwnFact note;  // for RunPlan::notes
};

/// Photographs at full size.
struct FullPhotographs {
  std::vector<Camera> cameras;  // at least one
  bool of_an_object = false;    // without surroundings: a quarter of the steps suffices
};

/// The training photographs of a dataset. Throws the errors of read_dataset_summary(). They
/// show an object if the file of the first has transparent pixels.
FullPhotographs full_photographs(const std::filesystem::path& dataset, DatasetOptions options);
/// The same for photographs that were read at full size; at least one.
FullPhotographs full_photographs(const std::vector<Photograph>& train);

/// The scale at which the longer side of the largest photograph has at most 1,000 pixels: 1, or
/// rounded down to four digits. The default for photographs whose cameras COLMAP finds.
double moderate_scale(std::span<const Camera> cameras);

/// How long a training is: one of both.
struct TrainingLength {
  double minutes = 0, steps = 0;
};
struct TrainingForecast {
  double scale = 1;  // of the photographs
  double minutes = 0, steps = 0;
};
/// `scale`: default: photographs_for() the minutes, or 1 for a number of steps. nullopt unless the
/// length is above 0.
std::optional<TrainingForecast> forecast_of(const TrainingLength& length,
                                            std::optional<double> scale,
                                            const FullPhotographs& full,
                                            const TrainingMethodInfo& method,
                                            double seconds_per_pixel);
/// A warning if `steps` are too few for a sharp scene: fewer than the photographs, or than a
/// quarter of the number that makes larger photographs worthwhile
/// (TrainingMethodInfo::least_steps).
std::optional<OwnFact> too_few_steps(double steps, const FullPhotographs& full,
                                     const TrainingMethodInfo& method);

/// A number with one digit: a forecast is no better.
double one_digit(double value);

/// The size for a training by this method.
PhotographSize photographs_for(double minutes, const FullPhotographs& full,
                               const TrainingMethodInfo& method, double seconds_per_pixel);

}  // namespace tureen
