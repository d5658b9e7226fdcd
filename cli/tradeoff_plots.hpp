// The plots of `tureen tradeoff`: error against the logarithm of time, of a scene or of several.
// E_render of drawing knobs, E_render of antialiasing ones and E_model each have a plot, and an
// axis, of their own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/figures.hpp"
#include "cli/tradeoff_report.hpp"
#include "cli/tradeoff_scenes.hpp"

namespace tureen::cli {

/// Which knob is most to blame for each outcome: of those that are turned, the one whose setting
/// alone, in the star, costs most decibels; of outcomes of the star the knob itself. None for the
/// defaults.
std::vector<std::optional<std::size_t>> dominant_knobs(const Panel& panel);

/// Two plots, or three where there is a dataset. Points: a time and an error, bars to the 95th
/// percentile of time, colour by the dominant knob, hollow where nothing is left out of the plan;
/// the front as a step line; R0, R1 and the limit as rules.
std::vector<Figure> tradeoff_plots(const TradeoffReport& report);

/// The same of what several scenes have in common: means of E_render against time relative to the
/// defaults, one plot for drawing knobs and one for antialiasing ones.
std::vector<Figure> means_plots(const TradeoffScenes& scenes);

/// tradeoff_plots() of every run, in their order: "1-drawing", "1-antialiasing", ..; a knob has the
/// colour that it has among the means, whatever knobs its own run lacks.
std::vector<Figure> scene_plots(const TradeoffScenes& scenes);

}  // namespace tureen::cli
