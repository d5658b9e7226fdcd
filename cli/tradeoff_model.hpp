// E_model for `tureen tradeoff`: each way to draw against photographs, as `tureen eval` measures.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/evaluation.hpp"
#include "cli/tradeoff_report.hpp"
#include "formats/dataset.hpp"

namespace tureen::cli {

struct ModelOptions {
  gl::Backend backend = gl::Backend::automatic;
  glm::vec3 background{0.0f};
  bool with_flip = true;
  /// The most pixels that the oracle draws for the outcomes that it emulates.
  double most_oracle_pixels = std::numeric_limits<double>::infinity();
  std::function<void(double)> progress = {};  // may throw to end it
};

/// At most `most` of the photographs, evenly spread over their order; all where `most` is 0.
std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most);

/// Why the emulated outcomes of the panel get no E_model: they would take more pixels than
/// `most_oracle_pixels`. Nothing where they get one, and where there are none.
std::optional<std::string> why_not_emulated(const Panel& panel,
                                            std::span<const Photograph> photographs,
                                            double most_oracle_pixels);

/// One entry for each outcome of the panel, nothing for generic twins, which draw the same, and for
/// emulated ones that take too long. Emulated ones are the oracle's pictures at the device's own
/// sample points: they differ from the defaults by the network's precision alone.
std::vector<std::optional<ModelError>> model_errors(const Panel& panel, const TriangleSoup& soup,
                                                    glm::dvec3 origin,
                                                    std::span<const Photograph> photographs,
                                                    const ModelOptions& options);

}  // namespace tureen::cli
