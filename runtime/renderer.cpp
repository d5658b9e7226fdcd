#include "runtime/renderer.hpp"

#include <algorithm>
#include <cassert>

#include "base/error.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/depth_probe.hpp"
#include "runtime/passes/pipeline.hpp"
#include "runtime/passes/resampled_pipeline.hpp"
#include "runtime/passes/targets.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

struct Renderer::State {
  State(const gl::Context& context, RenderPlan planned, const Bounds& soup_bounds,
        glm::dvec3 soup_origin, const RenderOptions& options)
      : plan(std::move(planned)),
        bounds(soup_bounds),
        origin(soup_origin),
        background(options.background),
        max_side(context.capabilities().max_image_side),
        api(context.capabilities().api) {}

  RenderPlan plan;  // pipeline refers to it
  Bounds bounds;
  glm::dvec3 origin;
  glm::vec4 background;
  std::unique_ptr<Pipeline> pipeline;
  int max_side;
  int width = 0, height = 0;
  FrameCamera last_frame;
  gl::Api api;
  std::optional<DepthProbe> probe;
};

DeviceLimits device_limits(const gl::Capabilities& capabilities) {
  return {.max_texture_size = capabilities.max_texture_size,
          .max_array_layers = capabilities.max_array_layers,
          .clip_control = capabilities.clip_control,
          .compute_shaders = capabilities.compute_shaders,
          .software = capabilities.software};
}

namespace {

std::unique_ptr<Pipeline> resampled(std::unique_ptr<Pipeline> pipeline, const RenderPlan& plan,
                                    const gl::Capabilities& capabilities) {
  const ImageLimit limit{capabilities.api, capabilities.max_image_side};
  const Quality& quality = plan.quality;
  if (quality.supersampling > 1)
    pipeline = make_supersampled(std::move(pipeline), quality.supersampling, limit);
  if (quality.resolution_scale < 1)
    pipeline = make_upscaled(std::move(pipeline), quality.resolution_scale, limit);
  return pipeline;
}

}  // namespace

Renderer::Renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                   const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  *this = Renderer(context, soup, origin, make_plan(soup, limits, options.plan), options);
}

Renderer::Renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                   RenderPlan plan, const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  *this = Renderer(context, prepare_soup(soup, origin, limits, std::move(plan)), options);
}

Renderer::Renderer(const gl::Context& context, PreparedSoup prepared, const RenderOptions& options)
    : state_(std::make_unique<State>(context, std::move(prepared.plan), prepared.bounds,
                                     prepared.origin, options)) {
  const gl::Capabilities& capabilities = context.capabilities();
  gl::use_plain_pixel_transfer();
  state_->pipeline = resampled(make_tureen_pipeline(capabilities, std::move(prepared.appearance),
                                                    prepared.geometry, state_->plan),
                               state_->plan, capabilities);
}

Renderer::Renderer(const gl::Context& context, std::unique_ptr<Pipeline> pipeline, RenderPlan plan,
                   const Bounds& bounds, glm::dvec3 origin, const RenderOptions& options)
    : state_(std::make_unique<State>(context, std::move(plan), bounds, origin, options)) {
  gl::use_plain_pixel_transfer();
  state_->pipeline = resampled(std::move(pipeline), state_->plan, context.capabilities());
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const RenderPlan& Renderer::plan() const { return state_->plan; }

void Renderer::set_background(glm::vec4 background) { state_->background = background; }

void Renderer::draw(const Camera& camera) {
  assert(camera.width > 0 && camera.height > 0);
  require_drawable(camera.width, camera.height, state_->max_side);
  if (camera.width != state_->width || camera.height != state_->height) {
    state_->width = state_->height = 0;  // if resize() throws, the next frame repeats it
    state_->pipeline->resize(camera.width, camera.height);
    state_->width = camera.width;
    state_->height = camera.height;
  }
  const glm::dvec3 eye = camera.eye() - state_->origin;
  const DepthStorage storage =
      state_->plan.reversed_depth ? DepthStorage::reversed_float : DepthStorage::fixed_24;
  state_->last_frame = {camera, eye, clip_range(state_->bounds, eye, forward_of(camera), storage)};
  state_->pipeline->draw(state_->last_frame, state_->background);
}

void Renderer::finish() const {
  // Without a frame, only uploads can be pending.
  gl::wait_for_device(state_->width > 0 ? state_->pipeline->color_framebuffer() : 0);
}

void Renderer::time_passes(gl::PassTimer* timer) { state_->pipeline->time_passes(timer); }

Image8 Renderer::read_color() const {
  assert(state_->width > 0 && "no frame has been drawn");
  return read_pixels(state_->pipeline->color_framebuffer(), state_->width, state_->height);
}

glm::ivec2 Renderer::sample_size() const { return state_->pipeline->sample_size(); }

std::vector<std::uint32_t> Renderer::read_faces() const {
  const GLuint framebuffer = state_->pipeline->visibility_framebuffer();
  if (!framebuffer) return {};
  return read_visible_faces(framebuffer, sample_size(), state_->plan.faces);
}

std::optional<glm::dvec3> Renderer::point_at(glm::dvec2 place) {
  const GLuint texture = state_->pipeline->depth_texture();
  const glm::dvec2 image(state_->width, state_->height), part = place / image;
  if (!texture || !(part.x >= 0 && part.x < 1 && part.y >= 0 && part.y < 1)) return {};
  const glm::dvec2 samples(sample_size());
  const glm::ivec2 sample(part.x * samples.x, (1 - part.y) * samples.y);
  if (!state_->probe) state_->probe.emplace(state_->api);
  const double stored =
      state_->probe->read(texture, glm::min(sample, sample_size() - glm::ivec2(1)));
  const auto depth = distance_of(
      stored, state_->last_frame.range,
      state_->plan.reversed_depth ? DepthStorage::reversed_float : DepthStorage::fixed_24);
  if (!depth) return {};
  const Camera& camera = state_->last_frame.camera;
  const glm::dvec3 ray((place.x - camera.cx) / camera.fx, (camera.cy - place.y) / camera.fy, -1.0);
  return camera.eye() + camera.world_from_view_rotation() * (*depth * ray);
}

void Renderer::blit_to(unsigned framebuffer, glm::ivec2 corner) const {
  blit_color(state_->pipeline->color_framebuffer(), framebuffer, {state_->width, state_->height},
             corner);
}

void Renderer::leave_context() {
  state_->pipeline->leave_context();
  state_->probe.reset();
  state_->width = state_->height = 0;
  finish();
}

std::size_t Renderer::device_bytes() const { return state_->pipeline->device_bytes(); }
std::size_t Renderer::target_bytes() const { return state_->pipeline->target_bytes(); }

}  // namespace tureen
