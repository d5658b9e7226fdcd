// How finely a scene is sampled when it is drawn. Stored with the scene in its file; the command
// line and the window override it.
#pragma once

#include <optional>
#include <string>

namespace tureen {

/// One of the two is 1.
struct Quality {
  /// Rows and columns that are drawn for each of the image's: 0.25..1. The image is enlarged
  /// bilinearly.
  double resolution_scale = 1.0;
  /// Samples a pixel along each axis: 1..8. The pixel is their mean.
  int supersampling = 1;

  bool operator==(const Quality&) const = default;
};

/// "50 % of the rows and columns", "2 x 2 samples a pixel", "one sample a pixel".
std::string describe(const Quality& quality);

/// Why nothing can be drawn like this (a value outside of its range, or both other than 1), or
/// nothing.
std::optional<std::string> defect(const Quality& quality);

}  // namespace tureen
