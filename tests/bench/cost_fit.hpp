// The cost model of a frame, t = a + b triangles + c fragments + d shaded pixels, fitted to
// measurements by least squares of the relative error: a frame of 1 ms counts as much as one of
// 1000 ms.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tureen::test {

struct CostSample {
  double triangles = 0;
  double fragments = 0;      // rasterised, before the depth test and before any is discarded
  double shaded_pixels = 0;  // that show a face
  double ms = 0;             // above 0
};

struct CostFit {
  /// Milliseconds a frame, a triangle, a fragment, a shaded pixel.
  std::array<double, 4> ms{};
  std::array<double, 4> standard_error{};  // of each, likewise
  std::vector<double> residuals;           // of each sample: (model - measured) / measured

  double predict(const CostSample& sample) const;
};

/// Nothing where there are fewer than five samples, or where they do not tell the four costs apart.
std::optional<CostFit> fit_costs(std::span<const CostSample> samples);

}  // namespace tureen::test
