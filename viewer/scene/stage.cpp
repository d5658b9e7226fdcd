#include "viewer/scene/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "base/error.hpp"
#include "base/steady_seconds.hpp"
#include "runtime/arrange_layers.hpp"
#include "runtime/device_forecast.hpp"
#include "runtime/splats/splat_sorter.hpp"

namespace tureen::viewer {

namespace {

/// A renderer of one layer by the choice.
Renderer prepare_layer(const DocumentLayer& layer, const Scene& scene,
                       const StageRequest& request) {
  const RenderOptions options = render_options(request.choice, scene);
  const PlacedLayer placed = placed_layer(*layer.primitives, layer);
  const DeviceLimits limits = device_limits(request.context.capabilities());
  return Renderer(request.context, prepare_scene(std::span(&placed, 1), limits, options), options);
}

RefusedLayer refused(const DocumentLayer& layer, const Scene& scene, const StageRequest& request,
                     const DeviceLimitError& error) {
  if (const Splats* splats = splats_of(layer))
    return {layer, device_forecast(*splats, make_splat_plan(*splats)).bytes, error.reason()};
  const TriangleSoup& soup = *soup_of(layer);
  const DeviceLimits limits = device_limits(request.context.capabilities());
  const RenderPlan plan = make_plan(soup, limits, render_options(request.choice, scene).plan);
  return {layer, device_forecast(soup, plan.soup(0)).bytes, error.reason()};
}

bool same_data(const DocumentLayer& a, const DocumentLayer& b) {
  return a.id == b.id && a.primitives == b.primitives;
}

/// The document's layers that are on the device, in its order, and those that have to be uploaded.
struct Difference {
  std::vector<DocumentLayer> present, missing;
};
Difference difference(const Stage& stage, const Document& document) {
  Difference result;
  for (const DocumentLayer& layer : document.layers) {
    const bool is_refused =
        std::any_of(stage.refused.begin(), stage.refused.end(),
                    [&](const RefusedLayer& each) { return same_data(each.layer, layer); });
    const bool is_present =
        std::any_of(stage.layers.begin(), stage.layers.end(),
                    [&](const DocumentLayer& each) { return same_data(each, layer); });
    if (is_present)
      result.present.push_back(layer);
    else if (!is_refused)
      result.missing.push_back(layer);
  }
  return result;
}

}  // namespace

Quality quality_of(const DrawingChoice& choice, const Scene& scene) {
  return choice.quality.value_or(scene.quality);
}

RenderOptions render_options(const DrawingChoice& choice, const Scene& scene) {
  RenderOptions options;
  options.plan = choice.plan;
  options.background = glm::vec4(scene.info.background, 1.0f);
  options.plan.quality = quality_of(choice, scene);
  return options;
}

std::string describe(const RefusedLayer& layer) {
  return fmt::format("Forecast: {:.1f} MiB. {}", double(layer.forecast_bytes) / (1 << 20),
                     layer.reason);
}

Renderer prepare_renderer(const SceneSource& source, const StageRequest& request) {
  RenderOptions options = render_options(request.choice, *source.scene);
  options.background = glm::vec4(background_of(source), 1.0f);
  const std::vector<PlacedLayer> layers = placed_layers(source.document.layers);
  const DeviceLimits limits = device_limits(request.context.capabilities());
  if (request.choice.pipeline == PipelineKind::tureen) {
    Renderer renderer(request.context, prepare_scene(layers, limits, options), options);
    renderer.sort_splats_with(std::make_unique<ThreadSplatSorter>());
    return renderer;
  }
  if (layers.size() > 1)
    throw UsageError("the baseline draws scenes of one layer; this scene has " +
                     std::to_string(layers.size()));
  RenderPlan plan = make_baseline_plan(*source.document.layers.front().primitives, options.plan);
  return Renderer(request.context, prepare_baseline(layers.front(), limits, std::move(plan)),
                  options);
}

std::unique_ptr<Stage> prepare_stage(const SceneSource& source, const StageRequest& request) {
  const double begin = steady_seconds();
  const std::vector<DocumentLayer>& layers = source.document.layers;
  try {
    Renderer renderer = prepare_renderer(source, request);
    renderer.leave_context();
    return std::make_unique<Stage>(
        Stage{request.choice, std::nullopt, std::move(renderer), layers, steady_seconds() - begin});
  } catch (const DeviceLimitError&) {
    if (layers.size() == 1 || request.choice.pipeline != PipelineKind::tureen) throw;
  }
  StageAddition fitting = prepare_addition(layers, *source.scene, request);
  if (fitting.renderers.empty()) {
    const RefusedLayer& first = fitting.refused.front();
    throw DeviceLimitError("layer " + first.layer.name + ": " + describe(first));
  }
  Renderer renderer = std::move(fitting.renderers.front());
  for (std::size_t i = 1; i < fitting.renderers.size(); ++i)
    renderer.add_layers(std::move(fitting.renderers[i]));
  renderer.leave_context();
  return std::make_unique<Stage>(Stage{request.choice, std::nullopt, std::move(renderer),
                                       std::move(fitting.layers), steady_seconds() - begin,
                                       std::move(fitting.refused)});
}

std::unique_ptr<Stage> prepare_debug_stage(const SceneSource& source, const StageRequest& request) {
  const double begin = steady_seconds();
  const RenderOptions options{.background = glm::vec4(background_of(source), 1.0f)};
  const DeviceLimits limits = device_limits(request.context.capabilities());
  const std::vector<PlacedLayer> layers = placed_layers(source.document.layers);
  Renderer renderer(request.context, prepare_debug_views(layers, limits, options), options);
  renderer.leave_context();
  return std::make_unique<Stage>(Stage{request.choice, DebugViews(layers), std::move(renderer),
                                       source.document.layers, steady_seconds() - begin});
}

StageAddition prepare_addition(const std::vector<DocumentLayer>& layers, const Scene& scene,
                               const StageRequest& request) {
  StageAddition result;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    try {
      Renderer renderer = prepare_layer(layers[i], scene, request);
      renderer.leave_context();
      result.renderers.push_back(std::move(renderer));
      result.layers.push_back(layers[i]);
    } catch (const DeviceLimitError& error) {
      result.refused.push_back(refused(layers[i], scene, request, error));
    }
    request.progress(double(i + 1) / double(layers.size()));
  }
  return result;
}

void add_to(Stage& stage, StageAddition addition) {
  assert(stage.can_grow());
  for (std::size_t i = 0; i < addition.layers.size(); ++i) {
    stage.renderer.add_layers(std::move(addition.renderers[i]));
    stage.layers.push_back(std::move(addition.layers[i]));
  }
  std::move(addition.refused.begin(), addition.refused.end(), std::back_inserter(stage.refused));
}

std::vector<DocumentLayer> sync(Stage& stage, const Document& document) {
  auto [present, missing] = difference(stage, document);
  std::vector<DocumentLayer>& layers = stage.layers;
  if (present.empty()) {  // a renderer has at least one layer
    for (std::size_t i = 0; i < layers.size(); ++i)
      stage.renderer.show_layer(i, layers[i].visible = false);
    return missing;
  }
  const bool same_order =
      std::equal(present.begin(), present.end(), layers.begin(), layers.end(), same_data);
  // The passes of debug views refer to the layers.
  if (!same_order && stage.debug_views) stage.renderer.set_passes({});
  arrange_layers(stage.renderer, layers, std::move(present), same_data);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    stage.renderer.place_layer(i, layers[i].world_from_layer);
    stage.renderer.show_layer(i, layers[i].visible);
  }
  if (!same_order && stage.debug_views) stage.debug_views.emplace(placed_layers(layers));
  return missing;
}

}  // namespace tureen::viewer
