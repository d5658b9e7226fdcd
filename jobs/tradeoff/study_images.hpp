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

/// Runs `work(i, check)` for 0 .. count - 1 on all cores. The work calls `check` regularly, with
/// any argument; it throws to stop the work. The calling thread passes the fraction done to
/// `progress`. Exceptions from `progress` or from the work end the work and are rethrown.
void on_all_cores(
    std::size_t count, const std::function<void(double)>& progress,
    const std::function<void(std::size_t i, const std::function<void(double)>& check)>& work);

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
