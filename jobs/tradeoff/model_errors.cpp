#include "jobs/tradeoff/model_errors.hpp"

#include "jobs/eval/evaluation.hpp"

namespace tureen::tradeoff {

namespace {

using Share = std::function<void(double)>;  // of the progress of one outcome; may throw

ModelError drawn_error(const Outcome& outcome, const Scene& scene,
                       std::span<const Photograph> photographs, const ModelOptions& options,
                       const Share& progress) {
  EvaluationOptions evaluation;
  evaluation.backend = options.backend;
  if (outcome.factor == Factor::baseline) evaluation.pipeline = PipelineKind::baseline;
  evaluation.plan.quality = outcome.applied.quality;
  evaluation.background = options.background;
  evaluation.metrics.with_flip = options.with_flip;
  evaluation.progress = progress;
  std::optional<Scene> reduced;
  // Editing is short compared with the photographs. It can be cancelled but shows no progress.
  if (has_edits(outcome.applied))
    reduced = edited(scene, outcome.applied, [&](double) { progress(0); });
  const ViewMetrics mean = evaluate(reduced ? *reduced : scene, photographs, evaluation).mean;
  return {mean.psnr_db, mean.ssim, mean.flip};
}

}  // namespace

std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most) {
  if (most == 0 || photographs.size() <= most) return photographs;
  std::vector<Photograph> chosen;
  for (std::size_t i = 0; i < most; ++i)
    chosen.push_back(std::move(photographs[i * photographs.size() / most]));
  return chosen;
}

void add_model_errors(Panel& panel, const Scene& scene, std::span<const Photograph> photographs,
                      const ModelOptions& options) {
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    Outcome& outcome = panel.outcomes[i];
    const Share progress = [&](double fraction) {
      if (options.progress)
        options.progress((double(i) + fraction) / double(panel.outcomes.size()));
    };
    if (outcome.factor != Factor::generic)
      outcome.model = drawn_error(outcome, scene, photographs, options, progress);
  }
}

}  // namespace tureen::tradeoff
