#include "jobs/tradeoff/study_images.hpp"

#include "base/threads/on_all_cores.hpp"

namespace tureen::tradeoff {

void report(const StudyOptions& options, StudyStage stage, double fraction) {
  if (options.progress) options.progress(stage, fraction);
}

std::vector<ImageF> oracle_images(const StudyScene& scene, const StudyOptions& options,
                                  Samples samples, StudyStage stage) {
  std::vector<ImageF> images(scene.cameras.size());
  const auto progress = [&](double fraction) { report(options, stage, fraction); };
  on_all_cores(images.size(), progress, [&](std::size_t i, const auto& check) {
    images[i] = reference_image(scene.scene, scene.cameras[i],
                                {.samples = samples,
                                 .subpixel_bits = options.subpixel_bits,
                                 .background = options.background,
                                 .progress = check});
  });
  return images;
}

std::vector<ImageF> as_shown(std::span<const ImageF> images) {
  std::vector<ImageF> rounded;
  for (const ImageF& image : images) rounded.push_back(to_float(quantised(image)));
  return rounded;
}

RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip) {
  RenderErrorMeter meter({.with_flip = with_flip});
  for (std::size_t i = 0; i < reference.size(); ++i) meter.add(reference[i], drawn[i]);
  return meter.result();
}

Errors errors_of(const References& references, std::span<const ImageF> drawn, bool with_flip) {
  Errors errors{error_between(references.judge, drawn, with_flip), std::nullopt};
  if (!references.exact.empty()) {
    const RenderError exact = error_between(references.exact, drawn, false);
    errors.second = ExactError{exact.psnr_db, exact.coverage_mismatch};
  }
  return errors;
}

}  // namespace tureen::tradeoff
