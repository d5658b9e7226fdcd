// The cases of `tureen bench`, each ready to draw: the plan, on request with either shading stage,
// the same pipeline without specialisations, the baseline, and the device's ceilings.
#pragma once

#include <memory>
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
  PlanPreferences plan = {};      // with the scene's quality, or another
  std::vector<std::string> only;  // names; empty: the usual ones
  bool ceilings = false;
};

/// The names that BenchCaseOptions::only may have.
std::span<const std::string> bench_case_names();

/// Something that draws a camera's view on a device.
class BenchCase {
 public:
  virtual ~BenchCase() = default;
  virtual void draw(const Camera& camera) = 0;
  virtual void finish() const = 0;
  virtual Image8 last_frame() const = 0;
  /// Of these views; a reason and no times where the device has no timer.
  virtual PassTimes passes(std::span<const Camera> cameras) = 0;

  BenchConfiguration configuration;  // as the result describes it

  BenchmarkCase benchmark_case();
};

/// A configuration that cannot draw the scene, and why.
struct SkippedCase {
  std::string name;
  std::string reason;
};

struct BenchCases {
  std::vector<std::unique_ptr<BenchCase>> list;  // the first is what ratios refer to
  double peak_mib = 0;                           // of the process, when the first was ready to draw
  std::vector<SkippedCase> skipped;
};

/// Plans and uploads for each; the times are in BenchCase::configuration. With --no-specialise or
/// --pipeline published there is only that case, and the ceilings on request. Cases that cannot
/// draw this soup are skipped, but UsageError and DeviceLimitError pass where --only names the
/// case, or, the first of them, where no case is left.
BenchCases make_cases(const BenchCaseOptions& options, const gl::Context& context,
                      const Scene& scene);

}  // namespace tureen
