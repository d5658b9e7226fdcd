#include "viewer/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/steady_seconds.hpp"
#include "formats/scene_file.hpp"
#include "formats/scene_preview.hpp"
#include "runtime/device_forecast.hpp"
#include "runtime/splats/splat_sorter.hpp"
#include "scene/middle_bounds.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

/// Smaller files are read in less than about a third of a second; a preview would only delay them.
constexpr std::uint64_t min_previewed_bytes = 16 << 20;
/// Each preview has about four times as many splats as the one before, and at most a quarter of the
/// file. All previews together then take at most a third of the time for the whole file.
constexpr std::uint64_t preview_growth = 4, max_preview_fraction = 4;
/// A larger part would hardly change the image; the page has the same limit
/// (web/viewer/preview.ts).
constexpr std::uint64_t max_preview_bytes = 256 << 20;
/// Headers of files with previews are smaller.
constexpr std::uint64_t max_header_bytes = 1 << 20;

ReadOptions options_of(const ReadRequest& request, std::function<void(double)> progress) {
  return {.max_splats = request.max_splats, .progress = std::move(progress)};
}

/// Appends the scene of a file, and its layers.
void append_scene(StageSource& source, const fs::path& path, const FileWatch& watch, Scene read) {
  auto scene = std::make_shared<Scene>(std::move(read));
  if (scene->info.name.empty()) scene->info.name = fs::path(short_name(path)).stem().string();
  for (std::size_t i = 0; i < scene->layers.size(); ++i) {
    Layer& layer = scene->layers[i];
    StageLayer& added = source.layers.emplace_back();
    added.bounds = framed_bounds(layer);
    added.world_from_layer = layer.world_from_layer;
    added.visible = layer.visible;
    added.primitives =
        std::make_shared<const Primitives>(std::exchange(layer.primitives, TriangleSoup{}));
    added.file = source.files.size();
    added.index = i;
  }
  source.files.push_back({path, watch, std::move(scene)});
}

void append_file(StageSource& source, const fs::path& path, const ReadOptions& options) {
  const FileWatch watch(path);
  append_scene(source, path, watch, read_scene(path, options));
}

void append_files(StageSource& source, const ReadRequest& request) {
  for (std::size_t i = 0; i < request.paths.size(); ++i) {
    request.begins(request.paths[i]);
    try {
      append_file(source, request.paths[i], options_of(request, [&](double done) {
                    request.progress((double(i) + done) / double(request.paths.size()));
                  }));
    } catch (const InputError& error) {
      const bool none_remains = source.files.empty() && i + 1 == request.paths.size();
      if (!request.unreadable || none_remains) throw;
      request.unreadable(request.paths[i], error.what());
    }
  }
}

void update_subject(StageSource& source) {
  const std::vector<LayerPlace> places(source.layers.begin(), source.layers.end());
  source.subject = subject_of(places, source.up.axis, source.files.front().header->cameras);
}

bool has_layer(const StageSource& source, std::size_t file, std::size_t index) {
  return std::any_of(source.layers.begin(), source.layers.end(), [&](const StageLayer& each) {
    return each.file == file && each.index == index;
  });
}

bool has_layers(const StageSource& source, std::size_t file) {
  return std::any_of(source.layers.begin(), source.layers.end(),
                     [&](const StageLayer& each) { return each.file == file; });
}

/// The files' headers, without removed layers and without files that have no others. The first file
/// stays, because cameras and settings are its own.
std::vector<Scene> headers_of(const StageSource& source) {
  std::vector<Scene> headers;
  for (std::size_t file = 0; file < source.files.size(); ++file) {
    if (file > 0 && !has_layers(source, file)) continue;
    Scene header = *source.files[file].header;
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < header.layers.size(); ++i)
      if (has_layer(source, file, i)) layers.push_back(std::move(header.layers[i]));
    header.layers = std::move(layers);
    headers.push_back(std::move(header));
  }
  return headers;
}

/// Sets what depends on all files.
void merge_files(StageSource& source) {
  source.scene = std::make_shared<const Scene>(merged(headers_of(source)));
  for (StageLayer& layer : source.layers) {
    const auto is_before = [&](const StageLayer& each) {
      return std::pair(each.file, each.index) < std::pair(layer.file, layer.index);
    };
    const auto place = std::count_if(source.layers.begin(), source.layers.end(), is_before);
    layer.name = source.scene->layers[std::size_t(place)].name;
    if (layer.name.empty()) layer.name = short_name(source.files[layer.file].path);
  }
}

void guess_up_axis(StageSource& source) {
  source.up.axis = glm::dvec3(source.scene->info.up);
  update_subject(source);
  source.up = guess_up(evidence_of(*source.scene, source.subject));
  source.subject.up = source.up.axis;
}

bool is_moved(const StageLayer& layer, const StageSource& source) {
  return layer.world_from_layer != source.as_read(layer).world_from_layer;
}

/// The layer of `source` that is the same as `layer` of `before`, or null.
const StageLayer* same_layer(const StageLayer& layer, const StageSource& before,
                             const StageSource& source) {
  for (const StageLayer& each : source.layers)
    if (each.file == layer.file && each.index == layer.index)
      return source.as_read(each).name == before.as_read(layer).name ? &each : nullptr;
  return nullptr;
}

/// Whether `before` had the layer when its file was read.
bool was_known(const StageLayer& layer, const StageSource& source, const StageSource& before) {
  if (layer.file >= before.files.size()) return false;
  const std::vector<Layer>& known = before.files[layer.file].header->layers;
  return layer.index < known.size() && known[layer.index].name == source.as_read(layer).name;
}

/// A renderer of one layer by the choice.
Renderer prepare_layer(const StageLayer& layer, const Scene& scene, const StageRequest& request) {
  const RenderOptions options = render_options(request.choice, scene);
  const PlacedLayer placed = placed_layer(*layer.primitives, layer);
  const DeviceLimits limits = device_limits(request.context.capabilities());
  return Renderer(request.context, prepare_scene(std::span(&placed, 1), limits, options), options);
}

RefusedLayer refused(const StageLayer& layer, const Scene& scene, const StageRequest& request,
                     const DeviceLimitError& error) {
  if (const auto* splats = std::get_if<Splats>(layer.primitives.get()))
    return {layer.name, device_forecast(*splats, make_splat_plan(*splats)).bytes, error.reason()};
  const TriangleSoup& soup = *layer.soup();
  const DeviceLimits limits = device_limits(request.context.capabilities());
  const RenderPlan plan = make_plan(soup, limits, render_options(request.choice, scene).plan);
  return {layer.name, device_forecast(soup, plan.soup(0)).bytes, error.reason()};
}

/// The panel's control that changes the assumption; "" if there is none.
std::string control_of(const Remark& remark) {
  const std::string_view setting = remark.kind->setting;
  return setting == "up"        ? "; Up in the panel View changes it"
         : setting == "profile" ? "; Profile in the panel Drawing changes it"
                                : "";
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

// -- sources --------------------------------------------------------------------------------------

std::vector<fs::path> StageSource::paths() const {
  std::vector<fs::path> result;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (has_layers(*this, i)) result.push_back(files[i].path);
  if (result.empty()) result.push_back(path());
  return result;
}

const Layer& StageSource::as_read(const StageLayer& layer) const {
  return files[layer.file].header->layers[layer.index];
}

bool StageSource::is_as_read() const {
  std::size_t at = 0;
  for (std::size_t file = 0; file < files.size(); ++file) {
    if (file > 0 && !has_layers(*this, file)) continue;
    for (std::size_t i = 0; i < files[file].header->layers.size(); ++i, ++at) {
      if (at == layers.size()) return false;
      const StageLayer& layer = layers[at];
      if (layer.file != file || layer.index != i || is_moved(layer, *this) ||
          layer.visible != as_read(layer).visible)
        return false;
    }
  }
  return at == layers.size();
}

bool has_splats(const StageSource& source) {
  return std::any_of(source.layers.begin(), source.layers.end(),
                     [](const StageLayer& layer) { return layer.primitives && !layer.soup(); });
}

std::vector<std::string> window_notes(const SceneInfo& info) {
  std::vector<std::string> notes = info.notes;
  for (const Remark& remark : info.remarks) notes.push_back(describe(remark) + control_of(remark));
  return notes;
}

std::vector<std::string> named_notes(const StageSource& source) {
  std::vector<Scene> headers = headers_of(source);
  headers.emplace_back();  // merged() returns a single scene without names
  return window_notes(merged(std::move(headers)).info);
}

std::size_t StageLayer::primitive_count() const {
  return soup() ? soup()->triangles.size() : count(std::get<Splats>(*primitives));
}

std::vector<PlacedLayer> placed_layers(const StageSource& source) {
  std::vector<PlacedLayer> result;
  for (const StageLayer& layer : source.layers)
    result.push_back(placed_layer(*layer.primitives, layer));
  return result;
}

std::optional<std::string> why_not(DebugView what, const StageSource& source) {
  if (what == DebugView::color) return std::nullopt;
  for (const StageLayer& layer : source.layers)
    if (const auto reason = tureen::why_not(what, *layer.primitives))
      return source.layers.size() > 1 ? layer.name + ": " + *reason : *reason;
  return std::nullopt;
}

int feature_count(const StageSource& source) {
  int fewest = LatticeTexture::features;
  for (const StageLayer& layer : source.layers)
    fewest = std::min(fewest, layer.soup() ? tureen::feature_count(*layer.soup()) : 0);
  return fewest;
}

StageSource read_source(const ReadRequest& request) {
  const double begin = steady_seconds();
  StageSource source;
  append_files(source, request);
  merge_files(source);
  guess_up_axis(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

StageSource read_more(const StageSource& before, const ReadRequest& request) {
  const double begin = steady_seconds();
  StageSource source = before;
  append_files(source, request);
  merge_files(source);
  update_subject(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

StageSource read_again(const StageSource& before, const ReadRequest& request) {
  const double begin = steady_seconds();
  StageSource source;
  const std::vector<fs::path> drawn = before.paths();
  const double total = double(drawn.size() + request.paths.size());
  double finished = 0;
  for (std::size_t i = 0; i < before.files.size(); ++i) {
    const SceneFile& file = before.files[i];
    if (!has_layers(before, i)) {
      source.files.push_back(file);  // its cameras and settings may be those of the scene
      continue;
    }
    request.begins(file.path);
    append_file(source, file.path, options_of(request, [&](double done) {
                  request.progress((finished + done) / total);
                }));
    finished += 1;
  }
  ReadRequest further = request;
  further.progress = [&](double done) {
    request.progress((finished + done * double(request.paths.size())) / total);
  };
  append_files(source, further);
  keep_changes(source, before);
  merge_files(source);
  guess_up_axis(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

std::optional<SourcePreview> read_source_preview(const fs::path& path, std::uint64_t shown,
                                                 const std::function<void()>& check) try {
  if (!fs::is_regular_file(path) || fs::file_size(path) < min_previewed_bytes) return {};
  const FileWatch watch(path);
  Input input = Input::open(path);
  std::vector<std::byte> prefix;
  const auto read_up_to = [&](std::uint64_t bytes) {
    const std::size_t before = prefix.size();
    check();
    prefix.resize(std::size_t(std::min(bytes, input.size())));
    input.read(std::span(prefix).subspan(before), "preview");
  };
  std::optional<PreviewSize> size;
  for (std::uint64_t bytes = 1 << 16; !size && bytes <= max_header_bytes; bytes *= 4) {
    read_up_to(bytes);
    // A preview has twice as many splats as the one that is named here as shown.
    size = preview_size(prefix, path.string(), preview_growth / 2 * shown);
  }
  if (!size || size->bytes == 0 ||
      size->bytes > std::min(input.size() / max_preview_fraction, max_preview_bytes))
    return {};
  read_up_to(std::max<std::uint64_t>(size->bytes, prefix.size()));
  check();
  std::optional<Scene> scene =
      read_preview(std::span(prefix).first(std::size_t(size->bytes)), path.string());
  if (!scene) return {};
  scene->info.notes.clear();
  scene->info.remarks.clear();
  SourcePreview preview{.source = {}, .bytes = size->bytes};
  append_scene(preview.source, path, watch, std::move(*scene));
  merge_files(preview.source);
  guess_up_axis(preview.source);
  return preview;
} catch (const Error&) {
  return {};
} catch (const fs::filesystem_error&) {
  return {};
}

void keep_changes(StageSource& source, const StageSource& before) {
  std::vector<StageLayer> layers;
  for (const StageLayer& old : before.layers) {
    const StageLayer* const same = same_layer(old, before, source);
    if (!same) continue;
    const Layer& read = source.as_read(*same);
    StageLayer layer = *same;
    layer.world_from_layer = is_moved(old, before) ? old.world_from_layer : read.world_from_layer;
    layer.visible = old.visible != before.as_read(old).visible ? old.visible : read.visible;
    layers.push_back(std::move(layer));
  }
  for (const StageLayer& layer : source.layers)
    if (!was_known(layer, source, before)) layers.push_back(layer);
  // A changed file may have lost all layers that were not removed.
  if (!layers.empty()) source.layers = std::move(layers);
  update_subject(source);
}

// -- stages ---------------------------------------------------------------------------------------

std::string describe(const RefusedLayer& layer) {
  return fmt::format("Forecast: {:.1f} MiB. {}", double(layer.forecast_bytes) / (1 << 20),
                     layer.reason);
}

Renderer prepare_renderer(const StageSource& source, const StageRequest& request) {
  const RenderOptions options = render_options(request.choice, *source.scene);
  if (request.choice.pipeline == PipelineKind::tureen) {
    Renderer renderer(request.context,
                      prepare_scene(placed_layers(source),
                                    device_limits(request.context.capabilities()), options),
                      options);
    renderer.sort_splats_with(std::make_unique<ThreadSplatSorter>());
    return renderer;
  }
  const std::vector<PlacedLayer> layers = placed_layers(source);
  if (layers.size() > 1)
    throw UsageError("the baseline draws scenes of one layer; this scene has " +
                     std::to_string(layers.size()));
  RenderPlan plan = make_baseline_plan(*source.layers.front().primitives, options.plan);
  return Renderer(request.context,
                  prepare_baseline(layers.front(), device_limits(request.context.capabilities()),
                                   std::move(plan)),
                  options);
}

std::unique_ptr<Stage> prepare_stage(const StageSource& source, const StageRequest& request) {
  const double begin = steady_seconds();
  Renderer renderer = prepare_renderer(source, request);
  renderer.leave_context();
  return std::make_unique<Stage>(
      Stage{{source}, request.choice, std::nullopt, std::move(renderer), steady_seconds() - begin});
}

std::unique_ptr<Stage> prepare_fitting_stage(const StageSource& source,
                                             const StageRequest& request) {
  try {
    return prepare_stage(source, request);
  } catch (const DeviceLimitError&) {
    if (source.layers.size() == 1 || request.choice.pipeline != PipelineKind::tureen) throw;
  }
  const double begin = steady_seconds();
  StageAddition fitting = prepare_addition(source, 0, request);
  if (fitting.renderers.empty()) {
    const RefusedLayer& first = fitting.refused.front();
    throw DeviceLimitError("layer " + first.name + ": " + describe(first));
  }
  auto stage = std::make_unique<Stage>(Stage{{source},
                                             request.choice,
                                             std::nullopt,
                                             std::move(fitting.renderers.front()),
                                             steady_seconds() - begin,
                                             std::move(fitting.refused)});
  for (std::size_t i = 1; i < fitting.renderers.size(); ++i)
    stage->renderer.add_layers(std::move(fitting.renderers[i]));
  stage->layers = std::move(fitting.layers);
  update_subject(*stage);
  stage->renderer.leave_context();
  return stage;
}

std::unique_ptr<Stage> prepare_debug_stage(const StageSource& source, const StageRequest& request) {
  const double begin = steady_seconds();
  const RenderOptions options{.background = glm::vec4(source.scene->info.background, 1.0f)};
  const DeviceLimits limits = device_limits(request.context.capabilities());
  const std::vector<PlacedLayer> layers = placed_layers(source);
  Renderer renderer(request.context, prepare_debug_views(layers, limits, options), options);
  renderer.leave_context();
  return std::make_unique<Stage>(Stage{
      {source}, request.choice, DebugViews(layers), std::move(renderer), steady_seconds() - begin});
}

StageAddition prepare_addition(const StageSource& source, std::size_t present,
                               const StageRequest& request) {
  StageAddition result{.source = source};
  for (std::size_t i = present; i < source.layers.size(); ++i) {
    const StageLayer& layer = source.layers[i];
    try {
      Renderer renderer = prepare_layer(layer, *source.scene, request);
      renderer.leave_context();
      result.renderers.push_back(std::move(renderer));
      result.layers.push_back(layer);
    } catch (const DeviceLimitError& error) {
      result.refused.push_back(refused(layer, *source.scene, request, error));
    }
    request.progress(double(i + 1 - present) / double(source.layers.size() - present));
  }
  return result;
}

void add_to(Stage& stage, StageAddition addition) {
  assert(stage.can_grow());
  for (Renderer& each : addition.renderers) stage.renderer.add_layers(std::move(each));
  StageSource source = std::move(addition.source);
  // The layers that are on the device now, in its order, with the names of the merged scene.
  std::vector<StageLayer> layers = stage.layers;
  std::move(addition.layers.begin(), addition.layers.end(), std::back_inserter(layers));
  source.layers = std::move(layers);
  merge_files(source);
  update_subject(source);
  static_cast<StageSource&>(stage) = std::move(source);
}

void arrange_layers(Stage& stage, std::vector<StageLayer> wanted) {
  std::vector<StageLayer>& layers = stage.layers;
  const auto find = [](std::vector<StageLayer>& among, const StageLayer& layer) {
    return std::find_if(among.begin(), among.end(), [&](const StageLayer& each) {
      return each.primitives == layer.primitives;
    });
  };
  std::erase_if(wanted, [&](const auto& each) { return find(layers, each) == layers.end(); });
  if (wanted.empty()) return;  // the user kept only layers that the device refused
  const bool same_order = std::equal(
      wanted.begin(), wanted.end(), layers.begin(), layers.end(),
      [](const StageLayer& a, const StageLayer& b) { return a.primitives == b.primitives; });
  // The passes of debug views refer to the layers.
  if (!same_order && stage.debug_views) stage.renderer.set_passes({});
  for (std::size_t i = layers.size(); i-- > 0;) {
    if (find(wanted, layers[i]) != wanted.end()) continue;
    stage.renderer.remove_layer(i);
    layers.erase(layers.begin() + std::ptrdiff_t(i));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto at = std::size_t(find(layers, wanted[i]) - layers.begin());
    if (at != i) {
      stage.renderer.swap_layers(i, at);
      std::swap(layers[i], layers[at]);
    }
    stage.renderer.place_layer(i, wanted[i].world_from_layer);
    stage.renderer.show_layer(i, wanted[i].visible);
  }
  layers = std::move(wanted);
  if (!same_order && stage.debug_views) stage.debug_views.emplace(placed_layers(stage));
  update_subject(stage);
}

}  // namespace tureen::viewer
