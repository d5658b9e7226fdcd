// How near a scene comes to photographs: what `tureen eval` measures, and `tureen train` at its
// end. The scene is drawn by the runtime, as everybody sees it, never by the trainer.
//
// Protocol: the rendering as the device writes it, 8 bits a channel, against the photograph over
// the background, which is not rounded again. PSNR from the mean squared difference of a view, SSIM
// of the border that is asked for, FLIP at 67 pixels per degree; each is taken view by view, and
// the mean is that of the views, as papers report it.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/metrics.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/photographs.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct EvaluationOptions {
  gl::Backend backend = gl::Backend::automatic;
  PlanPreferences plan = {};
  /// Behind the scene and behind photographs with alpha; display-referred.
  glm::vec3 background{0.0f};
  MetricOptions metrics = {.ssim_border = SsimBorder::valid};
  /// Called with each view's index, its photograph over the background, and its rendering, in any
  /// order and from several threads; may throw to end the evaluation.
  std::function<void(std::size_t view, const ImageF& photograph, const ImageF& rendering)> on_view =
      {};
  /// Called now and then with the fraction done, 0..1; may throw to end the evaluation.
  std::function<void(double)> progress = {};
};

struct ViewMetrics {
  std::string name;  // of the photograph
  double psnr_db = 0;
  double ssim = 0;
  double flip = 0;  // 0 where MetricOptions leave it out
};

struct Evaluation {
  std::vector<ViewMetrics> views;  // in the order of the photographs
  ViewMetrics mean;                // without a name
  std::string context;             // how the device was reached, and its name
  std::string renderer;
  std::vector<std::string> plan;                       // describe()
  std::vector<AppliedSpecialisation> specialisations;  // of the plan
};

/// Views are measured on all cores while others are drawn. There is one photograph at least, and
/// the soup has no defect(). Throws ContextError, DeviceLimitError, UsageError where the window of
/// the SSIM does not fit into a view, and what the callbacks throw.
Evaluation evaluate(const TriangleSoup& soup, glm::dvec3 origin,
                    std::span<const Photograph> photographs, const EvaluationOptions& options);

}  // namespace tureen
