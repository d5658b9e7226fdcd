// The oracle's pictures for `tureen tradeoff`, drawn on all cores.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "jobs/tradeoff/study.hpp"

namespace tureen::tradeoff {

/// Tells options.progress, where somebody listens.
void report(const StudyOptions& options, const std::string& task, double fraction);

/// Runs `work(i, check)` for 0 .. count - 1 on all cores; `check`, called now and then with
/// anything, ends it when it is to stop. The calling thread tells `progress` the fraction done;
/// what that throws ends the work and is thrown, as is what the work throws.
void on_all_cores(
    std::size_t count, const std::function<void(double)>& progress,
    const std::function<void(std::size_t i, const std::function<void(double)>& check)>& work);

/// One picture a camera. Throws what options.progress throws, soon after it did.
std::vector<ImageF> oracle_pictures(const StudyScene& scene, const StudyOptions& options,
                                    Samples samples);

/// In 8 bits a channel, as a screen shows them.
std::vector<ImageF> as_shown(std::span<const ImageF> pictures);

/// Over all pictures; as many drawn ones as references.
RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip);

/// Against both references; FLIP against the judge alone.
using Errors = std::pair<RenderError, std::optional<ExactError>>;
Errors errors_of(const References& references, std::span<const ImageF> drawn, bool with_flip);

}  // namespace tureen::tradeoff
