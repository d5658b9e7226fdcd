// E_model for `tureen tradeoff`: each way to draw against photographs, as `tureen eval` measures.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "jobs/tradeoff/panel.hpp"
#include "runtime/gl/context.hpp"
#include "scene/photographs.hpp"

namespace tureen::tradeoff {

/// How near a way to draw comes to photographs.
struct ModelError {
  double psnr_db = 0;  // the mean of the views' decibels, as eval says it
  double ssim = 0;     // border `valid`
  double flip = 0;     // 0 where it was left out
};

struct ModelOptions {
  gl::Backend backend = gl::Backend::automatic;
  glm::vec3 background{0.0f};
  bool with_flip = true;
  std::function<void(double)> progress = {};  // may throw to end it
};

/// At most `most` of the photographs, evenly spread over their order; all where `most` is 0.
std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most);

/// One entry for each outcome of the panel, nothing for generic twins, which draw the same.
std::vector<std::optional<ModelError>> model_errors(const Panel& panel, const TriangleSoup& soup,
                                                    glm::dvec3 origin,
                                                    std::span<const Photograph> photographs,
                                                    const ModelOptions& options);

}  // namespace tureen::tradeoff
