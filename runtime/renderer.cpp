#include "runtime/renderer.hpp"

#include <algorithm>
#include <cassert>

#include "base/error.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/passes/depth_probe.hpp"
#include "runtime/passes/filter_pass.hpp"
#include "runtime/passes/targets.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

namespace {

FrameFormat format_of(const PreparedScene& prepared, const RenderPlan& plan) {
  FrameFormat format{.reversed_depth = plan.reversed_depth};
  for (std::size_t i = 0; i < prepared.layers.size(); ++i) {
    if (!prepared.layers[i].soup) continue;
    format.visibility |= plan.layers[i].site == ShadingSite::deferred;
    format.image_store |= plan.layers[i].shading_stage == ShadingStage::compute;
  }
  return format;
}

}  // namespace

struct Renderer::State {
  State(const gl::Context& context, PreparedScene& prepared, const RenderOptions& options)
      : plan(std::move(prepared.plan)),
        background(options.background),
        device(context.capabilities()),
        target(format_of(prepared, plan)) {
    gl::use_plain_pixel_transfer();
    for (std::size_t i = 0; i < prepared.layers.size(); ++i) {
      PreparedLayer& layer = prepared.layers[i];
      places.push_back({layer.bounds, layer.origin});
      if (layer.soup)
        soups.push_back(std::make_unique<DeviceSoup>(device, std::move(layer.soup->appearance),
                                                     layer.soup->geometry, plan.layers[i]));
    }
    passes = prepared.make_passes({device, plan, soups});
    if (plan.quality != Quality{}) filter.emplace(plan.quality, device.api);
  }

  /// Calls act(pass) for each pass, the filter last.
  template <class Act>
  void for_each_pass(const Act& act) {
    for (const std::unique_ptr<Pass>& pass : passes) act(*pass);
    if (filter) act(*filter);
  }

  GLuint image_framebuffer() const {
    return filter ? filter->framebuffer() : target.color_framebuffer();
  }
  DepthStorage depth_storage() const {
    return plan.reversed_depth ? DepthStorage::reversed_float : DepthStorage::fixed_24;
  }
  void resize(glm::ivec2 new_size);
  void set_frame(const FrameInput& input);

  struct Place {
    Bounds bounds;
    glm::dvec3 origin;
  };

  const RenderPlan plan;  // soups and passes refer to it
  std::vector<Place> places;
  glm::vec4 background;
  gl::Capabilities device;
  FrameTarget target;
  std::vector<std::unique_ptr<DeviceSoup>> soups;
  Passes passes;
  std::optional<FilterPass> filter;  // for other than one sample a pixel
  glm::ivec2 size{0};                // of the last image; 0 before the first
  Frame frame;                       // the last one
  Camera camera;                     // of the last frame, at the image's size
  gl::PassTimer* timer = nullptr;
  std::optional<DepthProbe> probe;
};

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
  for_each_pass([&](Pass& pass) { pass.resize(target); });
  size = new_size;
}

void Renderer::State::set_frame(const FrameInput& input) {
  camera = input.camera;
  frame.input = input;
  if (filter) frame.input.camera = resampled(input.camera, target.size().x, target.size().y);
  frame.background = background;
  frame.layers.clear();
  for (const Place& place : places) {
    const glm::dvec3 eye = camera.eye() - place.origin;
    const ClipRange range = clip_range(place.bounds, eye, forward_of(camera), depth_storage());
    frame.layers.push_back({frame.input.camera, eye, range});
  }
  frame.range = frame.layers.front().range;
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

void Renderer::set_background(glm::vec4 background) { state_->background = background; }

void Renderer::add_pass(std::unique_ptr<Pass> pass) {
  state_->passes.push_back(std::move(pass));
  state_->size = glm::ivec2(0);  // the next frame calls its resize()
}

void Renderer::set_passes(Passes passes) {
  state_->passes = std::move(passes);
  state_->size = glm::ivec2(0);
}

std::span<const std::unique_ptr<DeviceSoup>> Renderer::soups() const { return state_->soups; }

void Renderer::draw(const FrameInput& input) {
  State& state = *state_;
  const glm::ivec2 size(input.camera.width, input.camera.height);
  assert(size.x > 0 && size.y > 0);
  require_drawable(size.x, size.y, state.device.max_image_side);
  if (size != state.size) state.resize(size);
  state.set_frame(input);
  state.target.begin(state.background);
  if (state.plan.reversed_depth) gl::use_zero_to_one_depth(state.device.api, true);
  state.for_each_pass([&](Pass& pass) {
    const gl::TimedPass timed(state.timer, pass.name());
    gl::use_plain_rasterisation(state.target.size().x, state.target.size().y);
    pass.draw(state.frame, state.target);
  });
  if (state.plan.reversed_depth) gl::use_zero_to_one_depth(state.device.api, false);
  gl::check("draw");
}

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

std::vector<std::uint32_t> Renderer::read_faces() const {
  if (!state_->target.has_visibility()) return {};
  return read_visible_faces(state_->target.visibility_framebuffer(), sample_size(),
                            state_->plan.layers.front().faces);
}

std::optional<glm::dvec3> Renderer::point_at(glm::dvec2 place) {
  const glm::dvec2 part = place / glm::dvec2(state_->size);
  if (!(part.x >= 0 && part.x < 1 && part.y >= 0 && part.y < 1)) return {};
  if (!state_->target.has_depth()) return {};
  const glm::dvec2 samples(sample_size());
  const glm::ivec2 sample(part.x * samples.x, (1 - part.y) * samples.y);
  if (!state_->probe) state_->probe.emplace(state_->device.api);
  const double stored = state_->probe->read(state_->target.depth_texture(),
                                            glm::min(sample, sample_size() - glm::ivec2(1)));
  const auto depth = distance_of(stored, state_->frame.range, state_->depth_storage());
  if (!depth) return {};
  const Camera& camera = state_->camera;
  const glm::dvec3 ray((place.x - camera.cx) / camera.fx, (camera.cy - place.y) / camera.fy, -1.0);
  return camera.eye() + camera.world_from_view_rotation() * (*depth * ray);
}

void Renderer::blit_to(unsigned framebuffer, glm::ivec2 corner) const {
  blit_color(state_->image_framebuffer(), framebuffer, state_->size, corner);
}

void Renderer::leave_context() {
  for (const std::unique_ptr<DeviceSoup>& soup : state_->soups) soup->leave_context();
  state_->for_each_pass([](Pass& pass) { pass.leave_context(); });
  state_->target.leave_context();
  state_->probe.reset();
  state_->size = glm::ivec2(0);
  finish();
}

std::size_t Renderer::device_bytes() const {
  std::size_t bytes = 0;
  for (const std::unique_ptr<DeviceSoup>& soup : state_->soups) bytes += soup->device_bytes();
  state_->for_each_pass([&](Pass& pass) { bytes += pass.device_bytes(); });
  return bytes;
}

std::size_t Renderer::target_bytes() const {
  std::size_t bytes = state_->target.bytes();
  state_->for_each_pass([&](Pass& pass) { bytes += pass.target_bytes(); });
  return bytes;
}

}  // namespace tureen
