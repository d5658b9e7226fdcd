#include "runtime/renderer.hpp"

#include <algorithm>
#include <cassert>
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

/// Appends the layers' places and soups.
void Renderer::State::upload(std::vector<PreparedLayer>& layers, std::span<const LayerPlan> plans) {
  assert(layers.size() == plans.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    PreparedLayer& layer = layers[i];
    std::unique_ptr<DeviceSoup> soup;
    std::unique_ptr<DeviceSplats> of_splats;
    std::unique_ptr<TiledSplats> tiled;
    with_layer_in_errors(places.size() + layers.size() - i > 1 ? layer.name : "", [&] {
      if (layer.soup)
        soup = std::make_unique<DeviceSoup>(device, std::move(layer.soup->appearance),
                                            layer.soup->geometry, std::get<SoupPlan>(plans[i]));
      if (layer.splats)
        of_splats = std::make_unique<DeviceSplats>(device, std::move(*layer.splats),
                                                   std::get<SplatPlan>(plans[i]));
      if (layer.tiled_splats)
        tiled = std::make_unique<TiledSplats>(
            TiledSplats{splatting::make_layer(std::move(*layer.tiled_splats)),
                        std::get<SplatPlan>(plans[i]).profile});
    });
    soups.push_back(std::move(soup));
    splats.push_back(std::move(of_splats));
    tiled_splats.push_back(std::move(tiled));
    places.push_back({{layer.bounds, layer.world_from_layer}, layer.visible});
  }
}

bool Renderer::State::has_splats() const {
  const auto exists = [](const auto& each) { return each != nullptr; };
  return std::any_of(splats.begin(), splats.end(), exists) ||
         std::any_of(tiled_splats.begin(), tiled_splats.end(), exists);
}

/// Uploads the splats that only tiles have needed so far.
void Renderer::State::upload_tiled_splats() {
  const TexelLayout layout = TexelLayout::of(device_limits(device));
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (splats[i] || !tiled_splats[i]) continue;
    const SplatPlan& layer_plan = std::get<SplatPlan>(plan.layers[i]);
    SplatSource source = prepare_splats(tiled_splats[i]->splats->data(), layout);
    splats[i] = std::make_unique<DeviceSplats>(device, std::move(source), layer_plan);
    splats[i]->set_layer(i);
  }
}

/// Calls add(), which appends layers, and arranges them. If that throws, the layers are as before.
template <class Add>
void Renderer::State::add_or_undo(const Add& add) {
  const std::size_t before = soups.size();
  try {
    add();
    arrange();
  } catch (...) {
    if (soup_passes.size() > before) soup_passes.resize(before);  // they refer to the soups
    drop_splat_pass();
    soups.resize(before);
    splats.resize(before);
    tiled_splats.resize(before);
    places.resize(before);
    plan.layers.resize(before);
    arrange();
    throw;
  }
}

/// Numbers the soups and makes the passes that are missing, after a change of the layers.
void Renderer::State::arrange() {
  shown.reset();
  const auto is_soup = [](const auto& each) { return each != nullptr; };
  const bool now_layered = std::count_if(soups.begin(), soups.end(), is_soup) > 1;
  // A change of the kind of plan needs other programs. One soup that remains of several keeps its
  // plan and programs, which draw it correctly.
  if (now_layered && !layered) soup_passes.clear();
  layered |= now_layered;
  if (layered)
    for (LayerPlan& each : plan.layers)
      if (auto* soup = std::get_if<SoupPlan>(&each)) make_layered(*soup);
  std::uint32_t first_slot = 0;
  for (std::size_t i = 0; i < soups.size(); ++i) {
    if (splats[i]) splats[i]->set_layer(i);
    if (tiled_splats[i]) tiled_splats[i]->layer = i;
    if (!soups[i]) continue;
    soups[i]->set_place(plan.soup(i), {i, first_slot, layered});
    first_slot += static_cast<std::uint32_t>(plan.soup(i).faces.size());
  }
  drop_splat_pass();
  if (draws_layers && has_splats()) {
    make_splat_pass();
    size = glm::ivec2(0);  // the next frame calls its resize()
  }
  const bool all_made = !draws_layers || soup_passes.size() == soups.size();
  if (!all_made)
    for (std::size_t i = soup_passes.size(); i < soups.size(); ++i)
      soup_passes.push_back(soups[i] ? make_soup_passes(*soups[i]) : SoupPasses{});
  if (all_made && target.format() == format()) {
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

/// Tiles blend if they can blend all layers, otherwise the device does, or samples alpha.
void Renderer::State::make_splat_pass() {
  if (plan.quality.splat_order == Quality::SplatOrder::stochastic) {
    upload_tiled_splats();  // of added layers that were prepared for another order
    splat_pass = std::make_unique<StochasticSplatPass>(device, splats, splat_format);
    return;
  }
  std::vector<const TiledSplats*> tiled;
  bool all = true;
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (tiled_splats[i]) tiled.push_back(tiled_splats[i].get());
    all &= tiled_splats[i] || !splats[i];
  }
  if (all && tiled.size() <= TilePass::max_layers) {
    splat_pass = std::make_unique<TilePass>(device, std::move(tiled), plan.quality.splat_order);
    return;
  }
  if (plan.quality.splat_order == Quality::SplatOrder::exact)
    throw UsageError("the exact order of splats needs tiles for all layers, and at most " +
                         std::to_string(TilePass::max_layers) + " layers of splats",
                     "prepare added layers with the same quality");
  upload_tiled_splats();
  auto raster = std::make_unique<SplatPass>(device, splats, splat_format);
  ordered_splats = &raster->splats();
  ordered_splats->sort_with(splat_sorter.get());
  splat_pass = std::move(raster);
}

void Renderer::State::remove(std::size_t layer) {
  const auto at = static_cast<std::ptrdiff_t>(layer);
  if (draws_layers) soup_passes.erase(soup_passes.begin() + at);
  drop_splat_pass();
  soups.erase(soups.begin() + at);
  splats.erase(splats.begin() + at);
  tiled_splats.erase(tiled_splats.begin() + at);
  places.erase(places.begin() + at);
  plan.layers.erase(plan.layers.begin() + at);
}

FrameFormat Renderer::State::format() const {
  FrameFormat result{.reversed_depth = plan.reversed_depth, .layered = layered};
  for (const std::unique_ptr<DeviceSoup>& soup : soups) {
    if (!soup) continue;
    result.visibility |= soup->plan().site == ShadingSite::deferred;
    result.image_store |= soup->plan().shading_stage == ShadingStage::compute;
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
  for (const Place& place : places)
    if (place.visible) visible_boxes.push_back(place.box);
  frame.range = clip_range(visible_boxes, camera, depth_storage());
  frame.layers.clear();
  for (const Place& place : places) {
    frame.layers.push_back(
        camera_in_layer(frame.input.camera, place.box.world_from_layer, frame.range));
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

std::size_t Renderer::layer_count() const { return state_->places.size(); }

void Renderer::place_layer(std::size_t layer, const glm::dmat4& world_from_layer) {
  assert(layer < layer_count());
  state_->shown.reset();
  state_->places[layer].box.world_from_layer = world_from_layer;
}

void Renderer::show_layer(std::size_t layer, bool visible) {
  assert(layer < layer_count());
  state_->shown.reset();
  state_->places[layer].visible = visible;
}

void Renderer::add_layers(PreparedScene prepared) {
  State& state = *state_;
  assert(state.draws_layers && !prepared.make_passes);
  assert(prepared.plan.reversed_depth == state.plan.reversed_depth);
  assert(state.places.size() + prepared.layers.size() <= max_layers);
  gl::use_plain_pixel_transfer();
  state.add_or_undo([&] {
    state.upload(prepared.layers, prepared.plan.layers);
    for (LayerPlan& each : prepared.plan.layers) state.plan.layers.push_back(std::move(each));
  });
}

void Renderer::add_layers(Renderer other) {
  State &state = *state_, &from = *other.state_;
  assert(state.draws_layers && from.draws_layers);
  assert(from.plan.reversed_depth == state.plan.reversed_depth);
  assert(state.places.size() + from.places.size() <= max_layers);
  from.soup_passes.clear();  // they refer to the soups
  from.drop_splat_pass();
  state.add_or_undo([&] {
    for (std::size_t i = 0; i < from.soups.size(); ++i) {
      state.soups.push_back(std::move(from.soups[i]));
      state.splats.push_back(std::move(from.splats[i]));
      state.tiled_splats.push_back(std::move(from.tiled_splats[i]));
      state.places.push_back(from.places[i]);
      state.plan.layers.push_back(std::move(from.plan.layers[i]));
    }
  });
}

void Renderer::remove_layer(std::size_t layer) {
  assert((state_->draws_layers || state_->passes.empty()) && layer < layer_count());
  state_->remove(layer);
  state_->arrange();
}

void Renderer::swap_layers(std::size_t a, std::size_t b) {
  State& state = *state_;
  assert((state.draws_layers || state.passes.empty()) && a < layer_count() && b < layer_count());
  std::swap(state.soups[a], state.soups[b]);
  std::swap(state.splats[a], state.splats[b]);
  std::swap(state.tiled_splats[a], state.tiled_splats[b]);
  std::swap(state.places[a], state.places[b]);
  std::swap(state.plan.layers[a], state.plan.layers[b]);
  if (state.draws_layers) std::swap(state.soup_passes[a], state.soup_passes[b]);
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
  state_->soup_passes.clear();
  state_->drop_splat_pass();
  state_->size = glm::ivec2(0);
}

std::span<const std::unique_ptr<DeviceSoup>> Renderer::soups() const { return state_->soups; }

std::span<const std::unique_ptr<DeviceSplats>> Renderer::splats() const { return state_->splats; }

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
  std::vector<VisibleFace> result(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] == no_face) continue;
    std::size_t layer = state.soups.size() - 1;
    while (!state.soups[layer] || slots[i] < state.soups[layer]->place().first_slot) --layer;
    const DeviceSoup& soup = *state.soups[layer];
    result[i] = {static_cast<std::uint32_t>(layer),
                 soup.plan().faces[slots[i] - soup.place().first_slot]};
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
  one.input.camera = cut_out_of(whole, corner, glm::ivec2(1));
  for (FrameCamera& layer : one.layers) layer.camera = cut_out_of(layer.camera, corner, {1, 1});
  FrameTarget pixel({.reversed_depth = plan.reversed_depth});
  pixel.resize({1, 1});
  upload_tiled_splats();
  SplatMeasures measures(device, splats, SplatMeasure::median_depth);
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
  for (const std::unique_ptr<DeviceSoup>& soup : state_->soups)
    if (soup) soup->leave_context();
  for (const std::unique_ptr<DeviceSplats>& splats : state_->splats)
    if (splats) splats->leave_context();
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
  if (const auto& soup = state_->soups[layer]) return soup->device_bytes();
  const auto& splats = state_->splats[layer];
  return splats ? splats->device_bytes() : 0;
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
