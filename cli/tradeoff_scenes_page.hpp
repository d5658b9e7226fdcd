// What `tureen tradeoff --import` makes of several runs as one HTML page that needs nothing beside
// it.
#pragma once

#include <string>
#include <vector>

#include "cli/figures.hpp"
#include "cli/tradeoff_scenes.hpp"

namespace tureen::cli {

/// The scenes, what their runs do not have in common, the means with their plots, every scene's own
/// figures, what was left out, and the plots of each scene. No plots where gnuplot is missing.
std::string tradeoff_scenes_page(const TradeoffScenes& scenes,
                                 const std::vector<DrawnFigure>& means,
                                 const std::vector<DrawnFigure>& of_scenes);

}  // namespace tureen::cli
