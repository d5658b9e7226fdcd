// The cases of `tureen bench`: the plan, optionally with either shading stage, or with either way
// to blend splats; the same pipeline without specialisations; the baseline; and two upper limits of
// the speed (ceilings): the triangles with an empty fragment shader, and a copy of the same number
// of pixels.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jobs/baseline/baseline.hpp"
#include "jobs/bench/bench_result.hpp"
#include "jobs/timing/benchmark.hpp"
#include "jobs/timing/pass_times.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct BenchCaseOptions {
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan = {};      // includes the sampling quality
  std::vector<std::string> only;  // names of cases; empty: the default cases
  bool ceilings = false;          // whether to add the upper limits
  bool opaque = false;            // the scene was made opaque: adds --opaque to the options
};

/// The names that BenchCaseOptions::only supports.
std::span<const std::string> bench_case_names();

/// Draws views on a device.
class BenchCase {
 public:
  virtual ~BenchCase() = default;
  virtual void draw(const FrameInput& input) = 0;
  virtual void finish() const = 0;
  virtual Image8 last_frame() const = 0;
  /// The mean times of passes over these views; a reason and no times if the device has no timer.
  virtual PassTimes passes(std::span<const Camera> cameras) = 0;
  /// Milliseconds a view in which the processor orders the splats, also of a moving camera. Empty
  /// if it orders none. `clock` is in seconds; null: the steady clock.
  virtual std::optional<double> order_ms(std::span<const Camera>,
                                         const std::function<double()>& /*clock*/) const {
    return std::nullopt;
  }
  /// Whether TilePass blends the scene's splats.
  virtual bool blends_in_tiles() const { return false; }

  BenchConfiguration configuration;  // its description in the result

  BenchmarkCase benchmark_case();
};

/// A configuration that cannot draw the scene, with the reason.
struct SkippedCase {
  std::string name;
  std::string reason;
};

struct BenchCases {
  std::vector<std::unique_ptr<BenchCase>> list;  // the first is the reference for ratios
  double peak_mib = 0;  // of the process, when the first case is ready to draw
  bool sort = false;    // frames sort splats: a sample is one frame, as of a moving camera
  std::vector<SkippedCase> skipped;
};

/// Plans and uploads each case of a scene with one layer; the times are in
/// BenchCase::configuration. The scene must outlive the cases. By default: the plan, the same by
/// raster if the plan blends splats in tiles, the same without specialisations, and the baseline.
/// With --no-specialise or --pipeline baseline only that case is made, plus the ceilings if
/// requested. A case that fails with UsageError or DeviceLimitError is skipped. The error is
/// rethrown if options.only names cases; the first error is rethrown if no case is left. The
/// shading stages and the ceiling of triangles are only of soups, and the ways to blend only of
/// splats: other scenes throw UsageError.
BenchCases make_cases(const BenchCaseOptions& options, const gl::Context& context,
                      const Scene& scene);

}  // namespace tureen
