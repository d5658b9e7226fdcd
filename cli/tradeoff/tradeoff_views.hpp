// The views of `tureen tradeoff`: judges for the errors, and other views that count visible faces
// for the triangle budget.
#pragma once

#include <string>
#include <vector>

#include "cli/measuring/bench_views.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct TradeoffViews {
  std::string camera_set;      // in the report: "scene:4", "hemisphere:8,adversarial"
  std::vector<Camera> judges;  // at least one
  /// The triangle budget counts visible faces in these views. If it counted in the views of the
  /// judges, removing faces that no judge sees would seem to cause no error.
  std::vector<Camera> counting;
  std::vector<std::string> notes;  // on missing data in camera files
};

struct DefaultViews {
  int count = 4;
  bool adversarial = false;  // also the 4 adversarial views
};

/// The sets of `options` at its single size. Without sets, `defaults.count` of the scene's cameras,
/// evenly spaced in their order, or views from a hemisphere if it has no cameras. Throws the
/// exceptions of bench_views().
TradeoffViews tradeoff_views(const BenchViewOptions& options, const DefaultViews& defaults,
                             const Scene& scene, const std::string& scene_path);

}  // namespace tureen::cli
