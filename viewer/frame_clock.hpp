// Times of the last frames: of the processor to submit a frame, and of the device to draw it. The
// device's clock is read some frames late, so that nothing waits for it. If it is misleading
// (software GL), the clock waits for each frame and measures both parts by wall time.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/gl/timer_query.hpp"
#include "runtime/renderer.hpp"

namespace tureen::viewer {

struct FrameParts {
  double processor_ms = 0;
  double device_ms = 0;
};

class FrameClock {
 public:
  static constexpr std::size_t frames_kept = 240;

  /// `clock` returns seconds; in a replayed session it stands still within a frame.
  FrameClock(const gl::Context& context, std::function<double()> clock);

  /// Draws a frame with the renderer, perhaps with an earlier order of splats, and records its
  /// times.
  void draw(Renderer& renderer, const FrameInput& input);
  /// The same for Renderer::refine().
  void refine(Renderer& renderer);

  /// Oldest first, at most frames_kept.
  const std::vector<FrameParts>& frames() const { return frames_; }
  /// The passes of the last frame with known pass times.
  const std::vector<gl::PassTimer::PassTime>& passes() const { return passes_; }
  /// The reason why pass times are unknown, as a sentence, or nullopt.
  const std::optional<std::string>& why_no_passes() const { return why_no_passes_; }
  void clear();

 private:
  void note(const FrameParts& parts);
  template <class Draw>
  void measure(Renderer& renderer, const Draw& draw);

  std::function<double()> clock_;
  std::optional<std::string> why_no_passes_;
  /// Used in rotation: each is read before its next use, when its frame is long finished.
  std::vector<std::unique_ptr<gl::PassTimer>> timers_;
  std::size_t turn_ = 0;
  std::vector<FrameParts> frames_;
  std::vector<gl::PassTimer::PassTime> passes_;
};

}  // namespace tureen::viewer
