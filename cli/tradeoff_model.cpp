#include "cli/tradeoff_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/tradeoff_pictures.hpp"
#include "runtime/tradeoff/reference.hpp"

namespace tureen::cli {

namespace {

using Share = std::function<void(double)>;  // of the progress of one outcome; may throw

ModelError drawn_error(const Outcome& outcome, const TriangleSoup& soup, glm::dvec3 origin,
                       std::span<const Photograph> photographs, const ModelOptions& options,
                       const Share& progress) {
  EvaluationOptions evaluation;
  evaluation.drawing.backend = options.backend;
  if (outcome.method == Method::published)
    evaluation.drawing.plan.pipeline = PipelineKind::published;
  else
    evaluation.drawing.plan.preset = outcome.preset;
  evaluation.background = options.background;
  evaluation.metrics.with_flip = options.with_flip;
  evaluation.progress = progress;
  const ViewMetrics mean = evaluate(soup, origin, photographs, evaluation).mean;
  return {mean.psnr_db, mean.ssim, mean.flip};
}

/// As evaluate() has it, of the oracle's pictures.
ModelError emulated_error(const tradeoff::ReferenceOptions& emulation, const TriangleSoup& soup,
                          glm::dvec3 origin, std::span<const Photograph> photographs,
                          const ModelOptions& options, const Share& progress) {
  MetricOptions metrics = EvaluationOptions().metrics;
  metrics.with_flip = options.with_flip;
  std::vector<Metrics> views(photographs.size());
  on_all_cores(photographs.size(), progress, [&](std::size_t i, const auto& check) {
    tradeoff::ReferenceOptions own = emulation;
    own.progress = check;
    const ImageF drawn = tradeoff::reference_picture(soup, origin, photographs[i].camera, own);
    views[i] = compare(composited(to_float(photographs[i].image), options.background),
                       to_float(quantised(drawn)), metrics);
  });
  ModelError mean;
  for (const Metrics& view : views) {
    mean.psnr_db += view.psnr_db / double(views.size());
    mean.ssim += view.ssim / double(views.size());
    mean.flip += view.flip / double(views.size());
  }
  return mean;
}

/// GL_SUBPIXEL_BITS of the device that draws the others.
int subpixel_bits_of(gl::Backend backend) {
  const gl::Context context = gl::Context::create({.backend = backend});
  return tradeoff::device_subpixel_bits();
}

}  // namespace

std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most) {
  if (most == 0 || photographs.size() <= most) return photographs;
  std::vector<Photograph> chosen;
  for (std::size_t i = 0; i < most; ++i)
    chosen.push_back(std::move(photographs[i * photographs.size() / most]));
  return chosen;
}

std::optional<std::string> why_not_emulated(const Panel& panel,
                                            std::span<const Photograph> photographs,
                                            double most_oracle_pixels) {
  double pixels = 0;
  for (const Photograph& photograph : photographs)
    pixels += double(photograph.camera.width) * photograph.camera.height;
  pixels *= double(
      std::count_if(panel.outcomes.begin(), panel.outcomes.end(),
                    [](const Outcome& outcome) { return outcome.method == Method::emulated; }));
  if (pixels <= most_oracle_pixels) return std::nullopt;
  return fmt::format(
      "no E_model of what is emulated: the oracle would draw {} pixels of photographs, more than "
      "the {} samples of the antialiasing reference; with a smaller --scale or fewer --photographs "
      "it does",
      counted(std::size_t(pixels)), counted(std::size_t(most_oracle_pixels)));
}

std::vector<std::optional<ModelError>> model_errors(const Panel& panel, const TriangleSoup& soup,
                                                    glm::dvec3 origin,
                                                    std::span<const Photograph> photographs,
                                                    const ModelOptions& options) {
  std::vector<std::optional<ModelError>> errors(panel.outcomes.size());
  const bool emulates = !why_not_emulated(panel, photographs, options.most_oracle_pixels);
  std::optional<int> subpixel_bits;
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    const Outcome& outcome = panel.outcomes[i];
    const Share progress = [&](double fraction) {
      if (options.progress) options.progress((double(i) + fraction) / double(errors.size()));
    };
    if (outcome.method == Method::specialised || outcome.method == Method::published) {
      errors[i] = drawn_error(outcome, soup, origin, photographs, options, progress);
    } else if (outcome.method == Method::emulated && emulates) {
      if (!subpixel_bits) subpixel_bits = subpixel_bits_of(options.backend);
      errors[i] = emulated_error(
          {.samples = tradeoff::Samples::device,
           .subpixel_bits = *subpixel_bits,
           .background = options.background,
           .mlp_precision = tradeoff::emulated_precision(panel.knobs, outcome.configuration)},
          soup, origin, photographs, options, progress);
    }
  }
  return errors;
}

}  // namespace tureen::cli
