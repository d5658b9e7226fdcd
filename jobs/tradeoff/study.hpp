// The measurement of `tureen tradeoff`: time and error of every configuration of an experiment, on
// one device, with one set of cameras. It prints and writes nothing.
//
// Time and error come from the same renderer: after timing it draws the compared frames once more.
// Configurations alternate frame by frame (jobs/timing/benchmark.hpp) in groups. Each group also
// measures the defaults. The times of a group are scaled until its default time equals that of the
// first group.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "jobs/tradeoff/panel.hpp"
#include "jobs/tradeoff/references.hpp"
#include "runtime/renderer.hpp"

namespace tureen::tradeoff {

struct StudyOptions {
  glm::vec3 background{0.0f};
  /// Sample points of the reference for edits: the device's, or exact.
  Samples samples = Samples::device;
  int subpixel_bits = 8;  // of the device
  int rounds = 5;
  /// Largest number of simultaneous renderers; each holds the scene on the device.
  std::size_t group = 12;
  std::size_t max_combinations = 64;  // of edits; as many of quality settings
  int max_samples = 4;                // largest number of supersampling samples per axis
  bool with_flip = true;
  /// As BenchmarkOptions::clock.
  std::function<double()> clock = nullptr;
  /// Called often with the current stage and its fraction done; may throw to cancel the study.
  std::function<void(const char* stage, double fraction)> progress = {};

  void report(const char* stage, double fraction) const {
    if (progress) progress(stage, fraction);
  }
};

/// The scene on the device, and the views.
struct StudyScene {
  const gl::Context& context;
  const Scene& scene;               // one layer, visible
  std::span<const Camera> cameras;  // at least one
  /// Views in which the visible pixels of each triangle are counted, or the weights of each splat
  /// are added. The edit that removes them uses these counts.
  std::span<const Camera> counting;
};

/// If the defaults cannot be drawn, throws the Renderer's error. Another configuration that cannot
/// be drawn is skipped with its reason.
Study run_study(const StudyScene& scene, const StudyOptions& options);

}  // namespace tureen::tradeoff
