// The views of `tureen tradeoff`: those that judge, and others by which the triangle budget
// chooses.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/bench_views.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct TradeoffViews {
  std::string camera_set;      // as the report names it: "scene:4", "hemisphere:8,adversarial"
  std::vector<Camera> judges;  // at least one
  /// What is visible is counted here: were it counted where it is judged, faces that no judge sees
  /// would seem to cost nothing.
  std::vector<Camera> counting;
  std::vector<std::string> notes;  // on what cameras lacked
};

struct DefaultViews {
  int count = 4;
  bool adversarial = false;  // the four adversarial ones, too
};

/// The sets of `options` at its one size; without sets `defaults`: so many of the scene's own
/// cameras, evenly spread over their order, or of a hemisphere where it has none. Throws what
/// bench_views() throws.
TradeoffViews tradeoff_views(const BenchViewOptions& options, const DefaultViews& defaults,
                             const Scene& scene, const std::string& scene_path);

}  // namespace tureen::cli
