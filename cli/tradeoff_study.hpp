// What `tureen tradeoff` measures: time and error of every configuration of an experiment, on one
// device, with one set of cameras. Says nothing and writes nothing.
//
// Time and error are taken of the same renderer: the frames that are compared are those that were
// timed. Configurations take turns frame by frame (runtime/benchmark.hpp), in groups, each of which
// the defaults are part of; a group's times are multiplied by what makes those of its defaults the
// first group's.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/frame_statistics.hpp"
#include "runtime/renderer.hpp"
#include "runtime/tradeoff/experiment.hpp"
#include "runtime/tradeoff/knobs.hpp"
#include "runtime/tradeoff/pareto.hpp"
#include "runtime/tradeoff/reference.hpp"
#include "soup/render_error.hpp"

namespace tureen::cli {

struct StudyOptions {
  glm::vec3 background{0.0f};
  /// Of the reference of drawing knobs: device or exact.
  tradeoff::Samples samples = tradeoff::Samples::device;
  int subpixel_bits = 8;  // of the device
  int rounds = 5;
  /// Most renderers at a time; each holds the scene on the device.
  std::size_t group = 12;
  tradeoff::FactorialLimits factorial = {};
  int most_samples = 4;  // an axis, of supersampling
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

/// Against References::exact.
struct ExactError {
  double psnr_db = 0;
  double coverage_mismatch = 0;
};

/// One way to draw, with the numbers it came to.
struct Outcome {
  tradeoff::Configuration configuration;  // of the panel's knobs
  std::string name;                       // in words: "lattice level 2"
  RenderPreset preset;
  bool specialised = true;  // or --no-specialise
  bool published = false;   // the published pipeline
  bool emulated = false;    // drawn by the oracle: no time, no bytes
  /// ms but for spread, of which FrameStatistics::spread says what it is.
  FrameStatistics ms;
  double device_mib = 0;
  RenderError error;                // against References::judge
  std::optional<ExactError> exact;  // drawing knobs alone
  std::vector<std::string> warnings;

  int departures() const { return tradeoff::departures(configuration); }
};

struct Skipped {
  std::string name;
  std::string reason;
};

/// What one reference is the judge of: drawing knobs, or antialiasing ones.
struct Panel {
  std::vector<tradeoff::Knob> knobs;
  std::vector<Outcome> outcomes;  // the defaults first
  std::vector<tradeoff::KnobRange> ranges;
  std::vector<Skipped> skipped;
  std::vector<std::string> notes;
  double aa_spread = 0;            // the largest of the groups
  std::vector<std::size_t> front;  // fastest first; of specialised, timed outcomes
  double hypervolume = 0;          // decades times decibels

  /// The reference's own pictures in 8 bits a channel: the best that a screen can show (R1).
  RenderError ideal;
};

/// Time and error as the front sees them, of those outcomes that may be on it; `index` says which
/// outcome each is.
struct Candidates {
  std::vector<tradeoff::Point> points;
  std::vector<std::size_t> index;
};
Candidates candidates(const Panel& panel);

struct Study {
  Panel drawing;
  Panel antialiasing;
  /// The published pipeline as an outcome of the drawing panel (R0), where it can draw this soup.
  std::optional<std::size_t> published;
  /// What the device's subpixel grid costs by itself: the reference that samples as the device does
  /// against the exact one. No knob changes it.
  RenderError grid;
  /// An outcome of the drawing panel. Left to the caller: what it has to keep to is no matter of
  /// these views alone.
  std::optional<std::size_t> choice;
};

/// The scene on the device, and the views.
struct StudyScene {
  const gl::Context& context;
  const TriangleSoup& soup;
  glm::dvec3 origin;
  std::span<const Camera> cameras;   // at least one
  std::span<const Camera> counting;  // by which the triangle budget chooses
};

/// What to think of the times where one configuration differs from itself by more than warming up
/// calls stable (BenchmarkOptions::stable_within): then who is cheapest is partly chance.
/// `aa_spread` is a fraction.
std::optional<std::string> spread_warning(double aa_spread);

/// Throws what Renderer throws for the defaults; a configuration that alone cannot be drawn is
/// skipped with the reason.
Study run_study(const StudyScene& scene, const StudyOptions& options);

}  // namespace tureen::cli
