// The oracle's pictures for `tureen tradeoff`, drawn on all cores.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/tradeoff_study.hpp"

namespace tureen::cli {

/// Tells options.progress, where somebody listens.
void report(const StudyOptions& options, const std::string& task, double fraction);

/// One picture a camera. With another precision than `exact` the network is emulated. Throws what
/// options.progress throws, soon after it did.
std::vector<ImageF> oracle_pictures(const StudyScene& scene, const StudyOptions& options,
                                    tradeoff::Samples samples,
                                    MlpPrecision precision = MlpPrecision::exact);

/// In 8 bits a channel, as a screen shows them.
std::vector<ImageF> as_shown(std::span<const ImageF> pictures);

/// Over all pictures; as many drawn ones as references.
RenderError error_between(std::span<const ImageF> reference, std::span<const ImageF> drawn,
                          bool with_flip);

/// Against both references; FLIP against the judge alone.
using Errors = std::pair<RenderError, std::optional<ExactError>>;
Errors errors_of(const References& references, std::span<const ImageF> drawn, bool with_flip);

}  // namespace tureen::cli
