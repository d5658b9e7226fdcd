// Times and compares configurations, group by group: the part of `tureen tradeoff` that uses the
// device.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/tradeoff/study.hpp"

namespace tureen::tradeoff {

/// Reference images of all cameras.
struct References {
  std::vector<ImageF> judge;
  /// Exact triangles, one sample per pixel; empty if the device's rounding is not measured.
  std::vector<ImageF> exact;
};

/// One case: its plan, and its properties known before the measurement.
struct Job {
  Outcome outcome;
  PlanPreferences plan;
};

Job job_of(const std::vector<QualitySetting>& settings, const Configuration& configuration,
           bool specialised);

class Measurer {
 public:
  /// Measures against `references`. Appends to the panel's outcomes, and cases that cannot be drawn
  /// to its skipped ones. All arguments must outlive this object.
  Measurer(const StudyScene& scene, const StudyOptions& options, const References& references,
           Panel& panel)
      : scene_(scene), options_(options), references_(references), panel_(panel) {}

  /// The very first job is the defaults, the control of every later group. Throws the Renderer's
  /// errors for them. Other jobs that fail with a UsageError or a DeviceLimitError are skipped.
  void measure(std::vector<Job> jobs, const char* stage);

 private:
  struct Running {
    Job job;
    std::unique_ptr<Renderer> renderer;
  };

  void report_share(double fraction) const;
  std::unique_ptr<Renderer> renderer_for(const Job& job) const;
  void measure_group(std::vector<Job> jobs);
  void time_and_compare(std::vector<Running>& running);
  void compare(std::vector<Running>& running, std::size_t first);

  const StudyScene& scene_;
  const StudyOptions& options_;
  const References& references_;
  Panel& panel_;
  std::optional<Job> control_;
  double control_ms_ = 0;
  std::pair<double, double> share_{0, 1};  // of the progress: begin and length of this group
  double made_ = 0;                        // the fraction of the group's renderers already created
  const char* stage_ = "";
};

}  // namespace tureen::tradeoff
