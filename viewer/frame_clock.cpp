#include "viewer/frame_clock.hpp"

#include <utility>

namespace tureen::viewer {

namespace {

/// Drivers let the processor run up to three frames ahead.
constexpr std::size_t frames_in_flight = 4;

}  // namespace

FrameClock::FrameClock(const gl::Context& context, std::function<double()> clock)
    : clock_(std::move(clock)), why_no_passes_(gl::timers_mislead(context.capabilities())) {
  if (!why_no_passes_ && !context.capabilities().timer_queries)
    why_no_passes_ = "this device has no timer queries";
  if (!why_no_passes_)
    for (std::size_t i = 0; i < frames_in_flight; ++i)
      timers_.push_back(std::make_unique<gl::PassTimer>(context));
}

void FrameClock::draw(Renderer& renderer, const FrameInput& input) {
  measure(renderer, [&] { renderer.draw(input, Renderer::SplatOrdering::earlier); });
}

void FrameClock::refine(Renderer& renderer) {
  measure(renderer, [&] { renderer.refine(); });
}

template <class Draw>
void FrameClock::measure(Renderer& renderer, const Draw& draw) {
  const double begin = clock_();
  if (timers_.empty()) {
    draw();
    const double asked = clock_();
    renderer.finish();
    note({1e3 * (asked - begin), 1e3 * (clock_() - asked)});
    return;
  }
  gl::PassTimer& timer = *timers_[turn_++ % timers_.size()];
  double device_ms = 0;
  if (turn_ > timers_.size()) {
    passes_ = timer.collect();
    for (const gl::PassTimer::PassTime& pass : passes_) device_ms += pass.ms;
  }
  renderer.time_passes(&timer);
  const double asking = clock_();
  draw();
  renderer.time_passes(nullptr);
  note({1e3 * (clock_() - asking), device_ms});
}

void FrameClock::note(const FrameParts& parts) {
  if (frames_.size() == frames_kept) frames_.erase(frames_.begin());
  frames_.push_back(parts);
}

void FrameClock::clear() {
  frames_.clear();
  passes_.clear();
}

}  // namespace tureen::viewer
