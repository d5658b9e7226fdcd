// How long the last frames took, in parts: what the processor does to ask for a frame, and what the
// device does to draw it. The device's own clock is read some frames late, so that nothing waits
// for it; where it misleads (software GL), the frame is waited for and the wall clock tells both.
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

  /// `clock` tells seconds; a replayed session's stands still within a frame.
  FrameClock(const gl::Context& context, std::function<double()> clock);

  /// Draws a frame of the renderer's and notes its parts.
  void draw(Renderer& renderer, const Camera& camera);

  /// The oldest first.
  const std::vector<FrameParts>& frames() const { return frames_; }
  /// (pass, ms) of the last frame whose passes are known.
  const std::vector<gl::PassTimer::PassTime>& passes() const { return passes_; }
  /// Why the passes are not known, a sentence; nothing where they are.
  const std::optional<std::string>& why_no_passes() const { return why_no_passes_; }
  void clear();

 private:
  void note(const FrameParts& parts);

  std::function<double()> clock_;
  std::optional<std::string> why_no_passes_;
  /// Taken in turn: the oldest is read when its turn comes again, and is long done then.
  std::vector<std::unique_ptr<gl::PassTimer>> timers_;
  std::size_t turn_ = 0;
  std::vector<FrameParts> frames_;
  std::vector<gl::PassTimer::PassTime> passes_;
};

}  // namespace tureen::viewer
