// E_model for `tureen tradeoff`: the error of each configuration against photographs, as in `tureen
// eval`.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "jobs/tradeoff/panel.hpp"
#include "runtime/gl/context.hpp"
#include "scene/photographs.hpp"

namespace tureen::tradeoff {

/// The error of a configuration against photographs.
struct ModelError {
  double psnr_db = 0;  // mean of the views' PSNR, as in eval
  double ssim = 0;     // border `valid`
  double flip = 0;     // 0 if not computed
};

struct ModelOptions {
  gl::Backend backend = gl::Backend::automatic;
  glm::vec3 background{0.0f};
  bool with_flip = true;
  std::function<void(double)> progress = {};  // may throw to cancel
};

/// At most `most` of the photographs, evenly spaced in their order; all if `most` is 0.
std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most);

/// One entry for each outcome of the panel; nullopt for generic twins, which draw the same images.
std::vector<std::optional<ModelError>> model_errors(const Panel& panel, const Scene& scene,
                                                    std::span<const Photograph> photographs,
                                                    const ModelOptions& options);

}  // namespace tureen::tradeoff
