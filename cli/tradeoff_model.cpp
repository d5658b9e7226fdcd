#include "cli/tradeoff_model.hpp"

namespace tureen::cli {

std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most) {
  if (most == 0 || photographs.size() <= most) return photographs;
  std::vector<Photograph> chosen;
  for (std::size_t i = 0; i < most; ++i)
    chosen.push_back(std::move(photographs[i * photographs.size() / most]));
  return chosen;
}

std::vector<std::optional<ModelError>> model_errors(const Panel& panel, const TriangleSoup& soup,
                                                    glm::dvec3 origin,
                                                    std::span<const Photograph> photographs,
                                                    const ModelOptions& options) {
  std::vector<std::optional<ModelError>> errors(panel.outcomes.size());
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    const Outcome& outcome = panel.outcomes[i];
    if (outcome.method != Method::specialised) continue;
    EvaluationOptions evaluation;
    evaluation.drawing.backend = options.backend;
    evaluation.drawing.plan.preset = outcome.preset;
    evaluation.background = options.background;
    evaluation.metrics.with_flip = options.with_flip;
    if (options.progress)
      evaluation.progress = [&](double fraction) {
        options.progress((double(i) + fraction) / double(errors.size()));
      };
    const ViewMetrics mean = evaluate(soup, origin, photographs, evaluation).mean;
    errors[i] = ModelError{mean.psnr_db, mean.ssim, mean.flip};
  }
  return errors;
}

}  // namespace tureen::cli
