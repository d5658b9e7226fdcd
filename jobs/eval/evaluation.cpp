#include "jobs/eval/evaluation.hpp"

#include <algorithm>
#include <cassert>
#include <deque>
#include <future>
#include <thread>

#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

namespace {

/// The errors of a drawn view. Runs on any thread.
ViewMetrics measure(std::size_t view, const Photograph& photograph, const Image8& rendering,
                    const EvaluationOptions& options) {
  ImageF truth = composited(to_float(photograph.image), options.background);
  const ImageF drawn = to_float(rendering);
  const double counted = equate_ignored(drawn, photograph.ignored, truth);
  const Metrics metrics = compare(truth, drawn, options.metrics);
  if (options.on_view) options.on_view(view, truth, drawn);
  return {photograph.camera.name, psnr_from_mse(counted * metrics.mse),
          metrics.ssim - (counted - 1) * (1 - metrics.ssim), counted * metrics.flip};
}

ViewMetrics mean_of(const std::vector<ViewMetrics>& views) {
  ViewMetrics sum;
  for (const ViewMetrics& view : views) {
    sum.psnr_db += view.psnr_db;
    sum.ssim += view.ssim;
    sum.flip += view.flip;
  }
  const double n = double(views.size());
  return {"", sum.psnr_db / n, sum.ssim / n, sum.flip / n};
}

RenderOptions render_options(const EvaluationOptions& options) {
  return {.plan = options.plan, .background = {options.background, 1.0f}};
}

Evaluation measured(const gl::Context& context, Renderer renderer,
                    std::span<const Photograph> photographs, const EvaluationOptions& options) {
  assert(!photographs.empty());
  Evaluation result;
  result.context = context.description();
  result.renderer = context.capabilities().renderer;

  // At most one view more than cores is in memory. On an exception, the destructor of `running`
  // waits for the remaining views.
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
  std::deque<std::future<ViewMetrics>> running;
  const auto take_first = [&] {
    result.views.push_back(running.front().get());
    running.pop_front();
  };
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    if (options.progress) options.progress(double(i) / double(photographs.size()));
    renderer.draw({photographs[i].camera});
    running.push_back(std::async(std::launch::async, measure, i, std::cref(photographs[i]),
                                 renderer.read_color(), std::cref(options)));
    if (running.size() == most) take_first();
  }
  while (!running.empty()) take_first();
  result.mean = mean_of(result.views);
  result.plan = describe(renderer.plan());
  result.specialisations = renderer.plan().applied();
  return result;
}

}  // namespace

Evaluation evaluate(const Scene& scene, std::span<const Photograph> photographs,
                    const EvaluationOptions& options) {
  const gl::Context context = gl::Context::create({.backend = options.backend});
  return measured(context, make_renderer(context, scene, options.pipeline, render_options(options)),
                  photographs, options);
}

Evaluation evaluate(const TriangleSoup& soup, glm::dvec3 origin,
                    std::span<const Photograph> photographs, const EvaluationOptions& options) {
  const gl::Context context = gl::Context::create({.backend = options.backend});
  return measured(context,
                  make_renderer(context, soup, origin, options.pipeline, render_options(options)),
                  photographs, options);
}

}  // namespace tureen
