#include "runtime/renderer.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string>

#include "base/error.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/image_tiles.hpp"
#include "runtime/layer_errors.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/renderer_state.hpp"
#include "runtime/splats/splat_measures.hpp"
#include "runtime/splats/splat_pass.hpp"
#include "runtime/splats/stochastic_splat_pass.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

DeviceLayers Renderer::State::upload(PreparedScene& prepared) const {
  gl::use_plain_pixel_transfer();
  const bool several = layers.size() + prepared.layers.size() > 1;
  DeviceLayers result;
  for (std::size_t i = 0; i < prepared.layers.size(); ++i) {
    const std::string name = several ? prepared.layers[i].place.name : "";
    with_layer_in_errors(name, [&] {
      result.push_back(std::make_unique<DeviceLayer>(device, std::move(prepared.layers[i]),
                                                     prepared.plan.layers[i]));
    });
  }
  return result;
}

bool Renderer::State::has_splats() const {
  return std::any_of(layers.begin(), layers.end(),
                     [](const auto& layer) { return layer->has_splats(); });
}

std::vector<DeviceSplats*> Renderer::State::splats() const {
  std::vector<DeviceSplats*> result;
  for (const std::unique_ptr<DeviceLayer>& layer : layers)
    if (layer->splats) result.push_back(&*layer->splats);
  return result;
}

void Renderer::State::upload_tiled_splats() {
  for (const std::unique_ptr<DeviceLayer>& layer : layers) layer->upload_tiled_splats(device);
}

/// Appends the layers and arranges all. If that throws, the layers are as before.
void Renderer::State::add(DeviceLayers added) {
  const std::size_t before = layers.size();
  std::move(added.begin(), added.end(), std::back_inserter(layers));
  try {
    arrange();
  } catch (...) {
    drop_splat_pass();  // it refers to the layers
    layers.resize(before);
    arrange();
    throw;
  }
}

/// Numbers the layers and makes the passes that are missing, after a change of the layers.
void Renderer::State::arrange() {
  shown.reset();
  const auto soups = std::count_if(layers.begin(), layers.end(),
                                   [](const auto& layer) { return layer->soup.has_value(); });
  // A change of the kind of plan needs other programs. One soup that remains of several keeps its
  // plan and programs, which draw it correctly.
  if (soups > 1 && !layered) {
    layered = true;
    for (const std::unique_ptr<DeviceLayer>& layer : layers) layer->passes = {};
  }
  plan.layers.clear();
  std::uint32_t first_slot = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    DeviceLayer& layer = *layers[i];
    plan.layers.push_back(layer.plan);
    if (layer.splats) layer.splats->set_layer(i);
    if (layer.tiled_splats) layer.tiled_splats->layer = i;
    if (!layer.soup) continue;
    if (layered) make_layered(std::get<SoupPlan>(*layer.plan));
    layer.soup->set_slots({i, first_slot, layered});
    first_slot += static_cast<std::uint32_t>(layer.soup->plan().faces.size());
  }
  drop_splat_pass();
  if (draws_layers && has_splats()) {
    make_splat_pass();
    size = glm::ivec2(0);  // the next frame calls its resize()
  }
  bool made = false;
  for (const std::unique_ptr<DeviceLayer>& layer : layers) {
    if (!draws_layers || !layer->soup || layer->passes.faces) continue;
    layer->passes = make_soup_passes(*layer->soup);
    made = true;
  }
  if (!made && target.format() == format()) {
    target.begin(background);  // the last frame no longer belongs to the layers
    return;
  }
  target.set_format(format());
  size = glm::ivec2(0);  // the next frame calls resize() of all passes
}

void Renderer::State::drop_splat_pass() {
  splat_pass.reset();
  ordered_splats = nullptr;
}

void Renderer::State::make_splat_pass() {
  const Quality::SplatOrder order = plan.quality.splat_order;
  std::vector<const TiledSplats*> tiled;
  std::size_t count = 0;
  for (const std::unique_ptr<DeviceLayer>& layer : layers) {
    if (layer->has_splats()) ++count;
    if (layer->tiled_splats) tiled.push_back(&*layer->tiled_splats);
  }
  plan.splats_in_tiles = blends_in_tiles(order, count, tiled.size());
  if (plan.splats_in_tiles) {
    splat_pass = std::make_unique<TilePass>(device, std::move(tiled), order);
    return;
  }
  upload_tiled_splats();  // of layers that were prepared otherwise
  if (order == Quality::SplatOrder::stochastic) {
    splat_pass = std::make_unique<StochasticSplatPass>(device, splats(), splat_format);
    return;
  }
  auto raster = std::make_unique<SplatPass>(device, splats(), splat_format);
  ordered_splats = &raster->splats();
  ordered_splats->sort_with(splat_sorter.get());
  splat_pass = std::move(raster);
}

FrameFormat Renderer::State::format() const {
  FrameFormat result{.reversed_depth = plan.reversed_depth, .layered = layered};
  for (const std::unique_ptr<DeviceLayer>& layer : layers) {
    if (!layer->soup) continue;
    const SoupPlan& soup = layer->soup->plan();
    result.visibility |= soup.site == ShadingSite::deferred;
    result.image_store |= soup.shading_stage == ShadingStage::compute;
  }
  return result;
}

void Renderer::State::resize(glm::ivec2 new_size) {
  size = glm::ivec2(0);  // if this throws, the next frame repeats it
  const glm::ivec2 samples = tureen::sample_size(plan.quality, new_size);
  if (std::max(samples.x, samples.y) > device.max_image_side) {
    const auto text = [](glm::ivec2 of) {
      return std::to_string(of.x) + "x" + std::to_string(of.y);
    };
    throw DeviceLimitError("an image of " + text(new_size) + " needs " + text(samples) +
                           " samples, but this device draws at most " +
                           std::to_string(device.max_image_side) + " a side");
  }
  target.resize(samples);
  if (filter) filter->set_image_size(new_size);
  for_each_pass_and_filter([&](Pass& pass) { pass.resize(target); });
  size = new_size;
}

void Renderer::State::set_frame(const FrameInput& input) {
  camera = input.camera;
  frame.input = input;
  if (filter) {
    frame.input.camera = resampled(input.camera, target.size().x, target.size().y);
    if (const std::optional<Camera>& whole = input.whole) {
      const glm::ivec2 samples = tureen::sample_size(plan.quality, {whole->width, whole->height});
      frame.input.whole = resampled(*whole, samples.x, samples.y);
    }
  }
  frame.samples_per_pixel = plan.quality.supersampling;
  frame.background = background;
  visible_boxes.clear();
  for (const std::unique_ptr<DeviceLayer>& layer : layers)
    if (layer->place.visible)
      visible_boxes.push_back({layer->place.bounds, layer->place.world_from_layer});
  frame.range = clip_range(visible_boxes, camera, depth_storage());
  frame.layers.clear();
  for (const std::unique_ptr<DeviceLayer>& layer : layers) {
    const LayerPlace& place = layer->place;
    frame.layers.push_back(
        camera_in_layer(frame.input.camera, place.world_from_layer, frame.range));
    frame.layers.back().visible = place.visible;
  }
}

DeviceLimits device_limits(const gl::Capabilities& capabilities) {
  return {.max_texture_size = capabilities.max_texture_size,
          .max_array_layers = capabilities.max_array_layers,
          .clip_control = capabilities.clip_control,
          .compute_shaders = capabilities.compute_shaders,
          .software = capabilities.software};
}

Renderer::Renderer(const gl::Context& context, PreparedScene prepared, const RenderOptions& options)
    : state_(std::make_unique<State>(context, prepared, options)) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const RenderPlan& Renderer::plan() const { return state_->plan; }

void Renderer::set_background(glm::vec4 background) {
  state_->shown.reset();
  state_->background = background;
}

std::size_t Renderer::layer_count() const { return state_->layers.size(); }

void Renderer::place_layer(std::size_t layer, const glm::dmat4& world_from_layer) {
  assert(layer < layer_count());
  state_->shown.reset();
  state_->layers[layer]->place.world_from_layer = world_from_layer;
}

void Renderer::show_layer(std::size_t layer, bool visible) {
  assert(layer < layer_count());
  state_->shown.reset();
  state_->layers[layer]->place.visible = visible;
}

void Renderer::add_layers(PreparedScene prepared) {
  State& state = *state_;
  assert(state.draws_layers && !prepared.make_passes);
  assert(prepared.plan.reversed_depth == state.plan.reversed_depth);
  assert(layer_count() + prepared.layers.size() <= max_layers);
  state.add(state.upload(prepared));
}

void Renderer::add_layers(Renderer other) {
  State &state = *state_, &from = *other.state_;
  assert(state.draws_layers && from.draws_layers);
  assert(from.plan.reversed_depth == state.plan.reversed_depth);
  assert(layer_count() + from.layers.size() <= max_layers);
  from.drop_splat_pass();  // it refers to the layers
  for (const std::unique_ptr<DeviceLayer>& layer : from.layers) layer->passes = {};
  state.add(std::move(from.layers));
}

void Renderer::remove_layer(std::size_t layer) {
  assert((state_->draws_layers || state_->passes.empty()) && layer < layer_count());
  state_->drop_splat_pass();  // it refers to the layer
  state_->layers.erase(state_->layers.begin() + static_cast<std::ptrdiff_t>(layer));
  state_->arrange();
}

void Renderer::swap_layers(std::size_t a, std::size_t b) {
  State& state = *state_;
  assert((state.draws_layers || state.passes.empty()) && a < layer_count() && b < layer_count());
  std::swap(state.layers[a], state.layers[b]);
  state.arrange();
}

void Renderer::add_pass(std::unique_ptr<Pass> pass) {
  state_->shown.reset();
  state_->passes.push_back(std::move(pass));
  state_->size = glm::ivec2(0);  // the next frame calls its resize()
}

void Renderer::set_passes(Passes passes) {
  state_->shown.reset();
  state_->passes = std::move(passes);
  state_->draws_layers = false;
  for (const std::unique_ptr<DeviceLayer>& layer : state_->layers) layer->passes = {};
  state_->drop_splat_pass();
  state_->size = glm::ivec2(0);
}

std::vector<DeviceSoup*> Renderer::soups() const {
  std::vector<DeviceSoup*> result;
  for (const std::unique_ptr<DeviceLayer>& layer : state_->layers)
    if (layer->soup) result.push_back(&*layer->soup);
  return result;
}

std::vector<DeviceSplats*> Renderer::splats() const { return state_->splats(); }

void Renderer::State::draw(const FrameInput& input) {
  set_frame(input);
  target.begin(background);
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, true);
  const auto draw_pass = [&](Pass& pass) {
    const gl::TimedPass timed(timer, pass.name());
    gl::use_plain_rasterisation(target.size().x, target.size().y);
    pass.draw(frame, target);
  };
  for_each_pass(draw_pass);
  gl::use_plain_rasterisation(target.size().x, target.size().y);
  target.end();
  if (filter) draw_pass(*filter);
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, false);
  gl::check("draw");
}

void Renderer::draw(const FrameInput& input, SplatOrdering order) {
  State& state = *state_;
  const glm::ivec2 size(input.camera.width, input.camera.height);
  assert(size.x > 0 && size.y > 0);
  state.shown.reset();
  require_drawable(size.x, size.y, state.device.max_image_side);
  if (size != state.size) state.resize(size);
  if (state.rest) state.rest->forget();
  state.rest_refused = false;
  state.frame.may_use_earlier_order = order == SplatOrdering::earlier;
  state.frame.first_sample = {};
  state.draw(input);
  state.shown = input;
}

void Renderer::sort_splats_with(std::unique_ptr<SplatSorter> sorter) {
  if (state_->ordered_splats) state_->ordered_splats->sort_with(sorter.get());
  state_->splat_sorter = std::move(sorter);
}

bool Renderer::splats_in_order() const { return state_->splats_in_order(); }

void Renderer::finish() const {
  // Without a frame, only uploads can be pending.
  gl::wait_for_device(state_->size.x > 0 ? state_->image_framebuffer() : 0);
}

void Renderer::time_passes(gl::PassTimer* timer) { state_->timer = timer; }

Image8 Renderer::read_color() const {
  assert(state_->size.x > 0 && "no frame has been drawn");
  return read_pixels(state_->image_framebuffer(), state_->size.x, state_->size.y);
}

glm::ivec2 Renderer::sample_size() const { return state_->target.size(); }

std::vector<VisibleFace> Renderer::read_faces() const {
  const State& state = *state_;
  if (state.size.x == 0 || !state.target.has_visibility()) return {};
  const std::vector<std::uint32_t> slots =
      read_visible_slots(state.target.visibility_framebuffer(), sample_size());
  const std::vector<DeviceSoup*> soups = this->soups();
  std::vector<VisibleFace> result(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] == no_face) continue;
    auto soup = soups.rbegin();
    while (slots[i] < (*soup)->slots().first_slot) ++soup;
    const auto& [layer, first_slot, layered] = (*soup)->slots();
    result[i] = {static_cast<std::uint32_t>(layer), (*soup)->plan().faces[slots[i] - first_slot]};
  }
  return result;
}

std::vector<glm::vec4> Renderer::read_splats() const {
  return state_->splat_pass && state_->size.x > 0 ? state_->splat_pass->read_blended()
                                                  : std::vector<glm::vec4>{};
}

/// The median depth of the splats at a sample of the last frame in front of the stored depth; 0 if
/// they stay more transparent than 1/2. `sample` is counted from the lower left corner. Only this
/// sample is drawn, as a frame of its own.
double Renderer::State::splat_depth_at(glm::ivec2 sample, float stored) {
  Frame one = frame;
  const Camera& whole = frame.input.camera;
  one.input.whole = frame.input.whole.value_or(whole);
  const glm::ivec2 corner(sample.x, whole.height - 1 - sample.y);
  one.input.camera = crop(whole, corner, glm::ivec2(1));
  for (FrameCamera& layer : one.layers) layer.camera = crop(layer.camera, corner, {1, 1});
  FrameTarget pixel({.reversed_depth = plan.reversed_depth});
  pixel.resize({1, 1});
  upload_tiled_splats();
  SplatMeasures measures(device, splats(), SplatMeasure::median_depth);
  measures.resize(pixel);
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, true);
  gl::use_plain_rasterisation(1, 1);
  pixel.begin(glm::vec4(0.0f));
  pixel.draw_color();
  glClearBufferfv(GL_DEPTH, 0, &stored);
  measures.draw(one, pixel);
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, false);
  const double depth = double(read_float_pixels(measures.framebuffer(), {1, 1})[0].r);
  gl::check("splat_depth_at");
  return depth;
}

std::optional<glm::dvec3> Renderer::point_at(glm::dvec2 place) {
  State& state = *state_;
  const glm::dvec2 part = place / glm::dvec2(state.size);
  if (!(part.x >= 0 && part.x < 1 && part.y >= 0 && part.y < 1)) return {};
  const glm::dvec2 samples(sample_size());
  const glm::ivec2 sample =
      glm::min(glm::ivec2(part.x * samples.x, (1 - part.y) * samples.y), sample_size() - 1);
  if (!state.probe) state.probe.emplace(state.device.api);
  const float stored = state.target.has_depth()
                           ? state.probe->read(state.target.depth_texture(), sample)
                           : state.target.far_depth();
  std::optional<double> depth =
      distance_of(double(stored), state.frame.range, state.depth_storage());
  if (state.has_splats())
    if (const double of_splats = state.splat_depth_at(sample, stored); of_splats > 0)
      depth = of_splats;
  if (!depth) return {};
  const Camera& camera = state.camera;
  const glm::dvec3 ray((place.x - camera.cx) / camera.fx, (camera.cy - place.y) / camera.fy, -1.0);
  return camera.eye() + camera.world_from_view_rotation() * (*depth * ray);
}

void Renderer::blit_to(unsigned framebuffer, glm::ivec2 corner) const {
  blit_color(state_->image_framebuffer(), framebuffer, state_->size, corner);
}

void Renderer::leave_context() {
  for (const std::unique_ptr<DeviceLayer>& layer : state_->layers) layer->leave_context();
  state_->for_each_pass_and_filter([](Pass& pass) { pass.leave_context(); });
  state_->target.leave_context();
  state_->probe.reset();
  state_->rest.reset();
  state_->shown.reset();
  state_->size = glm::ivec2(0);
  finish();
}

std::size_t Renderer::layer_bytes(std::size_t layer) const {
  assert(layer < layer_count());
  return state_->layers[layer]->device_bytes();
}

std::size_t Renderer::device_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < layer_count(); ++i) bytes += layer_bytes(i);
  state_->for_each_pass_and_filter([&](Pass& pass) { bytes += pass.device_bytes(); });
  return bytes;
}

std::size_t Renderer::target_bytes() const {
  std::size_t bytes = state_->target.bytes() + (state_->rest ? state_->rest->bytes() : 0);
  state_->for_each_pass_and_filter([&](Pass& pass) { bytes += pass.target_bytes(); });
  return bytes;
}

}  // namespace tureen
