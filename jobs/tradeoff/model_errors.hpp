// E_model for `tureen tradeoff`: the error of each configuration against photographs, as in `tureen
// eval`.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "jobs/tradeoff/panel.hpp"
#include "runtime/gl/context.hpp"
#include "scene/photographs.hpp"

namespace tureen::tradeoff {

struct ModelOptions {
  gl::Backend backend = gl::Backend::automatic;
  glm::vec3 background{0.0f};
  bool with_flip = true;
  std::function<void(double)> progress = {};  // may throw to cancel
};

/// At most `most` of the photographs, evenly spaced in their order; all if `most` is 0.
std::vector<Photograph> spread_out(std::vector<Photograph> photographs, std::size_t most);

/// Sets Outcome::model of the panel, except of generic twins, which draw the same images.
void add_model_errors(Panel& panel, const Scene& scene, std::span<const Photograph> photographs,
                      const ModelOptions& options);

}  // namespace tureen::tradeoff
