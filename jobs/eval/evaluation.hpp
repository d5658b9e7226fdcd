// The error of a scene against photographs, for `tureen eval` and the end of `tureen train`. The
// runtime draws the scene, never the trainer.
//
// Protocol: the device's 8-bit rendering is compared with the photograph over the background, which
// is not rounded again. PSNR comes from the mean squared error of a view, SSIM uses the requested
// border, FLIP 67 pixels per degree. Pixels that a mask excludes count as equal, and means
// are those over the others. Each is computed view by view and averaged over the views, as in
// papers. Holes and specks (image/specks.hpp) are counted in the same rendering.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/metrics.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/image_source.hpp"
#include "scene/photographs.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct EvaluationOptions {
  // Only for images from the runtime:
  gl::Backend backend = gl::Backend::automatic;
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan = {};

  /// Colour behind the scene and behind photographs with alpha; display-referred.
  glm::vec3 background{0.0f};
  MetricOptions metrics = {.ssim_border = SsimBorder::valid};
  /// Called with each view's index, its photograph over the background, and its rendering, whose
  /// alpha is its coverage. Where a mask excludes pixels, the photograph has those of the
  /// rendering. Calls come in any order and from several threads; they may throw to cancel.
  std::function<void(std::size_t view, const ImageF& photograph, const ImageF& rendering)> on_view =
      {};
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

struct ViewMetrics {
  std::string name = {};  // of the photograph
  double psnr_db = 0;
  double ssim = 0;
  double flip = 0;  // 0 if MetricOptions disable it
  /// Mean of hole_map() over the pixels where the photograph is opaque; 0 without such pixels.
  double holes = 0;
  double specks = 0;  // mean of speck_map()
};

struct Evaluation {
  std::vector<ViewMetrics> views;  // in the order of the photographs
  ViewMetrics mean;                // name is empty
  // Only for images from the runtime:
  std::string context;  // the method of access to the device, and its name
  std::string renderer;
  std::vector<std::string> plan;                       // describe()
  std::vector<AppliedSpecialisation> specialisations;  // in the plan
};

/// Measures views on all cores while the caller's thread draws others with `source`, whose images
/// are over options.background. Needs at least one photograph. Throws UsageError if the SSIM window
/// does not fit in a view, and exceptions from the source and the callbacks.
Evaluation evaluate(ImageSource& source, std::span<const Photograph> photographs,
                    const EvaluationOptions& options);
/// Measures images from the runtime. The layers have no defect(). Hidden layers are not drawn. The
/// baseline needs a scene of one soup. Also throws ContextError, DeviceLimitError and UsageError as
/// make_renderer does.
Evaluation evaluate(const Scene& scene, std::span<const Photograph> photographs,
                    const EvaluationOptions& options);
/// Measures images of one soup from the runtime.
Evaluation evaluate(const TriangleSoup& soup, glm::dvec3 origin,
                    std::span<const Photograph> photographs, const EvaluationOptions& options);

}  // namespace tureen
