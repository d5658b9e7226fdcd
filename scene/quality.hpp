// Sampling quality for rendering, and the order of splats. Stored with the scene in its file; the
// command line and the viewer override it.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace tureen {

/// At least one of resolution_scale and supersampling is 1.
struct Quality {
  /// Rendered rows and columns per row and column of the image, 0.25..1, default 1. The image is
  /// enlarged bilinearly.
  double resolution_scale = 1.0;
  /// Samples per pixel along each axis, 1..8, default 1. The pixel is their mean.
  int supersampling = 1;
  /// Which of two splats at a pixel is in front.
  enum class SplatOrder {
    center,  // by the view depth of the centres: the order of the authors' renderers
    exact,   // at each pixel by the depth along its ray (oracle/splats.hpp), on the processor
    /// As centre, but without blending and without an order: a splat of alpha a is drawn opaque
    /// with probability a. One sample is noisy; the mean of many is the image of centre.
    stochastic,
  } splat_order = SplatOrder::center;

  bool operator==(const Quality&) const = default;
};

/// In files and options, in the order of the enumeration.
inline constexpr std::array<const char*, 3> splat_order_names{"centre", "exact", "stochastic"};
const char* name_of(Quality::SplatOrder order);

/// Whether the image is as large as its samples: neither resolution scale nor supersampling.
bool has_one_sample_a_pixel(const Quality& quality);

/// The settings that differ from their defaults: "50 % of the rows and columns", "2 x 2 samples a
/// pixel, splats in exact order"; without any, "one sample per pixel".
std::string describe(const Quality& quality);

/// The reason why rendering with these settings is impossible (a value out of range, or both
/// resolution scale and supersampling other than 1), or nullopt.
std::optional<std::string> defect(const Quality& quality);

}  // namespace tureen
