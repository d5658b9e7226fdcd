#include "jobs/eval/evaluation.hpp"

#include <algorithm>
#include <cassert>
#include <deque>
#include <future>
#include <numeric>
#include <thread>

#include "image/specks.hpp"
#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer_images.hpp"

namespace tureen {

namespace {

double mean_of(std::span<const float> values, std::size_t count) {
  return count == 0 ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / double(count);
}

double hole_fraction(const ImageF& photograph, const ImageF& drawn) {
  const auto opaque = std::count_if(photograph.pixels.begin(), photograph.pixels.end(),
                                    [](const glm::vec4& pixel) { return pixel.a >= 1.0f; });
  return mean_of(hole_map(photograph, drawn), std::size_t(opaque));
}

/// The errors of a drawn view. Runs on any thread.
ViewMetrics measure(std::size_t view, const Photograph& photograph, const Image8& rendering,
                    const EvaluationOptions& options) {
  ImageF truth = composited(to_float(photograph.image()), options.background);
  const std::vector<std::uint8_t> ignored = photograph.ignored();
  const ImageF drawn = to_float(rendering);
  const double counted = equate_ignored(drawn, ignored, truth);
  for (std::size_t i = 0; i < ignored.size(); ++i)
    if (ignored[i]) truth.pixels[i].a = 0;  // not among the opaque pixels
  MetricOptions metric_options = options.metrics;
  metric_options.ignored = ignored;
  const Metrics metrics = compare(truth, drawn, metric_options);
  if (options.on_view) options.on_view(view, truth, drawn);
  return {.name = photograph.camera.name,
          .psnr_db = metrics.psnr_db,
          .ssim = metrics.ssim,
          .flip = metrics.flip,
          .holes = hole_fraction(truth, drawn),
          .specks = counted * mean_of(speck_map(truth, drawn), drawn.pixels.size())};
}

ViewMetrics mean_of(const std::vector<ViewMetrics>& views) {
  ViewMetrics sum;
  for (const ViewMetrics& view : views) {
    sum.psnr_db += view.psnr_db;
    sum.ssim += view.ssim;
    sum.flip += view.flip;
    sum.holes += view.holes;
    sum.specks += view.specks;
  }
  const double n = double(views.size());
  return {.psnr_db = sum.psnr_db / n,
          .ssim = sum.ssim / n,
          .flip = sum.flip / n,
          .holes = sum.holes / n,
          .specks = sum.specks / n};
}

RenderOptions render_options(const EvaluationOptions& options) {
  return {.plan = options.plan, .background = {options.background, 1.0f}};
}

Evaluation measured(const gl::Context& context, Renderer renderer,
                    std::span<const Photograph> photographs, const EvaluationOptions& options) {
  RendererImages images(renderer, options.background);
  Evaluation result = evaluate(images, photographs, options);
  result.context = context.description();
  result.renderer = context.capabilities().renderer;
  result.plan = describe(renderer.plan());
  result.specialisations = renderer.plan().applied();
  return result;
}

}  // namespace

Evaluation evaluate(ImageSource& source, std::span<const Photograph> photographs,
                    const EvaluationOptions& options) {
  assert(!photographs.empty());
  Evaluation result;
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
    running.push_back(std::async(std::launch::async, measure, i, std::cref(photographs[i]),
                                 source.image({photographs[i].camera}), std::cref(options)));
    if (running.size() == most) take_first();
  }
  while (!running.empty()) take_first();
  result.mean = mean_of(result.views);
  return result;
}

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
