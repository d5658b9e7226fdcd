// The result of a benchmark: what ran where, and the times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/machine.hpp"
#include "jobs/timing/frame_statistics.hpp"
#include "jobs/timing/pass_times_gap.hpp"
#include "runtime/plan/specialisation.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct BenchProgram {
  std::string version;                 // "0.1.0"
  std::string commit = "unknown";      // what git describes
  std::vector<std::string> arguments;  // as typed, from "bench" on
  std::string build = {};              // program_build(); empty where unknown
};

struct BenchScene {
  std::string name;
  std::string path;  // as typed
  std::uint64_t triangles = 0;
  std::string appearance;  // appearance_name()
};

struct BenchDevice {
  std::string context;   // "EGL, OpenGL 4.5 core"
  std::string renderer;  // GL_RENDERER
  std::string vendor;    // GL_VENDOR
  std::string version;   // GL_VERSION
  bool software = false;
};

struct BenchProtocol {
  std::string clock;            // what times were read from, a sentence for people
  bool processor_time = false;  // of all threads, instead of time that passed
  int rounds = 0;               // asked for; a measurement says how many were made
  double aa_spread = 0;         // the largest of all measurements
};

/// What happens before the first frame, of the first configuration; never part of a frame's time.
struct BenchLoad {
  double read_ms = 0;    // the file, until the soup is in memory
  double plan_ms = 0;    // make_plan
  double upload_ms = 0;  // buffers, textures and shaders, until the device has finished
  double peak_mib = 0;   // largest resident set of the process then, without targets; 0: not known
  double device_mib = 0;
};

struct BenchConfiguration {
  std::string name;                  // "tureen", "generic", "published", "empty fragments", ..
  std::vector<std::string> options;  // of `tureen render` that draw the same; empty for ceilings
  std::vector<std::string> plan;     // describe()
  double plan_ms = 0;
  double upload_ms = 0;
  double device_mib = 0;
  /// Of the plan; none in files of earlier versions.
  std::vector<AppliedSpecialisation> specialisations = {};
};

/// One configuration with one set of cameras at one size.
struct BenchMeasurement {
  std::string configuration;
  std::string camera_set;  // "hemisphere:8", ..
  std::string size;        // "1280x720", or "full", "half", "quarter" of recorded cameras
  int width = 0;           // of the first view, as height
  int height = 0;
  int views = 0;
  int frames_per_sample = 1;
  int frames = 0;            // timed ones: views * rounds * frames_per_sample
  FrameStatistics frame_ms;  // with its rounds and samples
  double fps = 0;            // 1000 / mean
  double aa_spread = 0;      // of the first configuration against itself, with these cameras
  bool stable = true;        // the warm-up came to rest

  /// (pass, milliseconds by the device's clock) in frame order, a mean over the views; empty, or a
  /// part of the frame, for the reason in `passes_gap`.
  std::vector<std::pair<std::string, double>> passes_ms;
  PassTimesGap passes_gap = PassTimesGap::none;
  std::string passes_reason;
  /// All passes together by the device's own clock, to be held against frame_ms.
  std::optional<double> gpu_ms;

  std::vector<double> views_ms;      // the median of each view
  std::string pixels_hash;           // of the last frame that was timed; 16 hexadecimal digits
  std::optional<std::string> image;  // its PNG, where one was asked for
};

struct BenchResult {
  std::string date;  // "2026-11-21T15:04:05Z"
  BenchProgram program;
  BenchScene scene;
  Machine machine;
  BenchDevice device;
  BenchProtocol protocol;
  BenchLoad load;
  std::vector<BenchConfiguration> configurations;
  std::vector<BenchMeasurement> measurements;
  std::vector<std::string> notes;  // on reading the scene and cameras, on what was left out
  /// Largest resident set of the process after all measurements: with targets, and with everybody
  /// who took part. Nothing where it cannot be told.
  std::optional<double> peak_mib = {};
};

/// The configuration of this name, or nothing.
const BenchConfiguration* find_configuration(const BenchResult& result, const std::string& name);

/// One set of cameras at one size.
struct BenchViews {
  std::string camera_set;  // as the result names it: "hemisphere:8", ..
  std::string size;        // "1280x720", or "full", "half", "quarter" of recorded cameras
  std::vector<Camera> cameras;
};

}  // namespace tureen
