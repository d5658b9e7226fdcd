// Training runs as a picture: the loss against steps, and the PSNR against time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/training_log.hpp"

namespace tureen::cli {

struct TrainingRun {
  std::string name;  // in the legend
  std::vector<TrainingRecord> records;
};

/// One SVG that needs nothing beside it, for light and dark pages. Left: the loss, smoothed, on a
/// logarithmic scale. Right: the PSNR of training batches, smoothed and thin, and of held-out views
/// where it was measured, as points that tell their numbers when pointed at. Values that are no
/// numbers are left out. There is one run at least, and one record in each.
std::string training_plot(std::span<const TrainingRun> runs);

/// What all of them begin with, by which one is told from somebody's drawing: its width, as well.
inline constexpr const char* training_plot_beginning =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 960 ";

/// Values at places 0, 1, .. as a line should show them: an exponential moving average, begun at
/// the first value without its bias, over about `window` of them; what is no number is skipped and
/// stays none. Window 1 changes nothing.
std::vector<double> smoothed(std::span<const double> values, double window);

}  // namespace tureen::cli
