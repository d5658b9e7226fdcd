// What `tureen tradeoff` measures: time and error of every configuration of an experiment, on one
// device, with one set of cameras. Says nothing and writes nothing.
//
// Time and error are taken of the same renderer: the frames that are compared are drawn by the one
// that was timed, once more. Configurations take turns frame by frame (jobs/timing/benchmark.hpp),
// in groups, each of which the defaults are part of; a group's times are multiplied by what makes
// those of its defaults the first group's.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "jobs/tradeoff/experiment.hpp"
#include "jobs/tradeoff/panel.hpp"
#include "jobs/tradeoff/reference.hpp"
#include "runtime/renderer.hpp"

namespace tureen::tradeoff {

struct StudyOptions {
  glm::vec3 background{0.0f};
  /// Of the reference of drawing settings: device or exact.
  Samples samples = Samples::device;
  int subpixel_bits = 8;  // of the device
  int rounds = 5;
  /// Most renderers at a time; each holds the scene on the device.
  std::size_t group = 12;
  FactorialLimits factorial = {};
  int max_samples = 4;  // an axis, of supersampling
  bool with_flip = true;
  /// As BenchmarkOptions::clock.
  std::function<double()> clock = nullptr;
  /// Called often with what is being done and the fraction of it; may throw to end the study.
  std::function<void(const std::string& task, double fraction)> progress = {};
};

/// Pictures of all cameras that the drawn ones are held against.
struct References {
  std::vector<ImageF> judge;
  /// Of exact triangles, one sample a pixel; empty where nobody asks what the device rounds.
  std::vector<ImageF> exact;
};

/// The scene on the device, and the views.
struct StudyScene {
  const gl::Context& context;
  const TriangleSoup& soup;
  glm::dvec3 origin;
  std::span<const Camera> cameras;   // at least one
  std::span<const Camera> counting;  // by which the triangle budget chooses
};

/// Throws what Renderer throws for the defaults; a configuration that alone cannot be drawn is
/// skipped with the reason.
Study run_study(const StudyScene& scene, const StudyOptions& options);

}  // namespace tureen::tradeoff
