// The oracle's images for `tureen tradeoff`, drawn on all cores.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "jobs/tradeoff/study.hpp"

namespace tureen::tradeoff {

/// Calls options.progress, if set.
void report(const StudyOptions& options, StudyStage stage, double fraction);

/// One image a camera. Rethrows exceptions from options.progress with a short delay.
std::vector<ImageF> oracle_images(const StudyScene& scene, const StudyOptions& options,
                                  Samples samples, StudyStage stage);

/// The images rounded to 8 bits a channel, as on a screen.
std::vector<ImageF> as_shown(std::span<const ImageF> images);

/// The error over all images; both spans have the same length.
RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip);

/// The errors against both references; FLIP only against the judge.
using Errors = std::pair<RenderError, std::optional<ExactError>>;
Errors errors_of(const References& references, std::span<const ImageF> drawn, bool with_flip);

}  // namespace tureen::tradeoff
