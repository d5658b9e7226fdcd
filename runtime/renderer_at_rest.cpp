// The image at rest of a Renderer.
#include <cassert>

#include "base/error.hpp"
#include "runtime/renderer_state.hpp"

namespace tureen {

namespace {

/// Distance of the samples of two frames at rest for the random numbers of splats: more than the
/// largest image, and 64 times that is exact in floats.
constexpr int samples_apart = 1 << 15;

}  // namespace

bool Renderer::shows(const FrameInput& input) const {
  return state_->shown == input && state_->splats_in_order();
}

bool Renderer::has_image_at_rest() const {
  const State& state = *state_;
  const Quality& quality = state.plan.quality;
  if (quality.resolution_scale < 1 || !state.draws_layers || !state.passes.empty() ||
      !state.device.float_targets || frames_at_rest(quality.supersampling) == 0)
    return false;
  for (const std::unique_ptr<DeviceLayer>& layer : state.layers) {
    if (!layer->place.visible) continue;
    const auto* splats = std::get_if<SplatPlan>(layer->plan.get());
    if (!splats || splats->profile.low_pass == SplatProfile::LowPass::none ||
        quality.splat_order == Quality::SplatOrder::stochastic)
      return true;
  }
  return false;
}

bool Renderer::can_refine() const {
  const State& state = *state_;
  return state.shown && !state.rest_refused && state.splats_in_order() && has_image_at_rest() &&
         !(state.rest && state.rest->complete());
}

/// Returns false if the device lacks the memory.
bool Renderer::State::begin_rest() {
  if (!rest) rest.emplace(device.api);
  try {
    rest->begin(size, frame_framebuffer(), frames_at_rest(plan.quality.supersampling));
    return true;
  } catch (const DeviceLimitError&) {
    rest.reset();
    return false;
  }
}

void Renderer::refine() {
  assert(can_refine());
  State& state = *state_;
  if (!state.rest || state.rest->frames() == 0) state.rest_refused = !state.begin_rest();
  if (state.rest_refused) return;
  const int index = state.rest->frames();
  FrameInput input = *state.shown;
  input.whole = input.whole.value_or(input.camera);
  const glm::dvec2 position = position_at_rest(index, state.plan.quality.supersampling);
  input.camera.cx -= position.x;
  input.camera.cy -= position.y;
  state.frame.may_use_earlier_order = false;
  state.frame.first_sample = {(index + 1) * samples_apart, 0};
  state.draw(input);
  state.rest->add(state.filter ? state.filter->texture() : state.target.color_texture(),
                  state.background);
  gl::check("refine");
}

void Renderer::draw_at_rest(const FrameInput& input) {
  draw(input);
  while (can_refine()) refine();
}

}  // namespace tureen
