// The end of a training run: the scene measured by the runtime, and the result as JSON.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "jobs/eval/evaluation.hpp"
#include "jobs/training/training_method.hpp"

namespace tureen {

struct TrainingOutcome {
  TrainingSummary training;
  std::optional<Evaluation> evaluation;  // none if the runtime cannot draw the scene here
  std::string why_not_drawn;             // only without an evaluation
  std::vector<std::string> output;       // paths of the written files
};

/// Measures the runtime's images, which users will see: sets `evaluation`, or `why_not_drawn`.
void evaluate(TrainingOutcome& outcome, const Scene& scene, std::span<const Photograph> views,
              const std::function<void(double)>& progress);

/// The last line of `tureen train --json`; `views`: number of test views; `scale`: of
/// the photographs.
Json to_json(const TrainingOutcome& outcome, std::size_t views, double scale);

}  // namespace tureen
