// Times and compares ways to draw, group by group: the part of `tureen tradeoff` that touches the
// device.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/tradeoff/study.hpp"

namespace tureen::tradeoff {

/// One case: how it draws, and what is known of it before it is measured.
struct Job {
  Outcome outcome;
  PlanPreferences plan;
};

Job job_of(const std::vector<QualitySetting>& settings, const Configuration& configuration,
           bool specialised);

class Measurer {
 public:
  /// Measures against `references` and appends to the panel's outcomes, what cannot be drawn to its
  /// skipped ones. All must outlive this.
  Measurer(const StudyScene& scene, const StudyOptions& options, const References& references,
           Panel& panel)
      : scene_(scene), options_(options), references_(references), panel_(panel) {}

  /// The first job ever is the defaults, the control of every later group. Throws what the Renderer
  /// throws for them; other jobs that a UsageError or a DeviceLimitError refuses are skipped.
  void measure(std::vector<Job> jobs, const std::string& task);

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
  std::pair<double, double> share_{0, 1};  // of the progress: where this group begins, and how much
  double made_ = 0;                        // the part of the group's renderers that are there
  std::string task_;
};

}  // namespace tureen::tradeoff
