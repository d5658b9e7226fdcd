// A plot of a dataset's cameras and points as SVG: from above, and from the side.
#pragma once

#include <string>

#include "formats/dataset/dataset.hpp"

namespace tureen::cli {

/// An SVG document of 1000 x 560 user units. Both panels have the same scale and show the box of
/// all camera positions; the side's horizontal axis is that of the view from above. Each camera is
/// a dot with a line in its viewing direction; training views are blue, test views orange. Points
/// from structure from motion inside the panels are grey, at most 4,000 of them, evenly chosen in
/// the file's order. A bar shows the length of a round number of units.
std::string camera_plot(const DatasetSummary& dataset);

}  // namespace tureen::cli
