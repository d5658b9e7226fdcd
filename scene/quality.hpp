// Sampling quality for rendering. Stored with the scene in its file; the command line and the
// viewer override it.
#pragma once

#include <optional>
#include <string>

namespace tureen {

/// At least one of the two settings is 1.
struct Quality {
  /// Rendered rows and columns per row and column of the image, 0.25..1, default 1. The image is
  /// enlarged bilinearly.
  double resolution_scale = 1.0;
  /// Samples per pixel along each axis, 1..8, default 1. The pixel is their mean.
  int supersampling = 1;

  bool operator==(const Quality&) const = default;
};

/// "50 % of the rows and columns", "2 x 2 samples a pixel", "one sample a pixel".
std::string describe(const Quality& quality);

/// The reason why rendering with these settings is impossible (a value out of range, or both other
/// than 1), or nullopt.
std::optional<std::string> defect(const Quality& quality);

}  // namespace tureen
