// The result of a benchmark: program, scene, machine, device and times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/platform/machine.hpp"
#include "jobs/timing/frame_statistics.hpp"
#include "jobs/timing/pass_times_gap.hpp"
#include "runtime/plan/specialisation.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct BenchProgram {
  std::string version;                 // "0.1.0"
  std::string commit = "unknown";      // from git describe
  std::vector<std::string> arguments;  // as typed, from "bench" on
  std::string build = {};              // program_build(); empty if unknown
};

struct BenchScene {
  std::string name;
  std::string path;  // as typed
  std::uint64_t triangles = 0;
  std::string appearance;  // appearance_name(), or describe() of splats
  std::uint64_t splats = 0;
};

struct BenchDevice {
  std::string context;   // "EGL, OpenGL 4.5 core"
  std::string renderer;  // GL_RENDERER
  std::string vendor;    // GL_VENDOR
  std::string version;   // GL_VERSION
  bool software = false;
};

struct BenchProtocol {
  std::string clock;            // description of the clock
  bool processor_time = false;  // over all threads, instead of wall time
  int rounds = 0;               // requested; FrameStatistics::rounds has the completed ones
  double aa_spread = 0;         // the largest of all measurements
};

/// Divides bytes for the members "_mib".
inline constexpr double bytes_per_mib = 1 << 20;

/// Work before the first frame of the first configuration; never part of a frame's time.
struct BenchLoad {
  double read_ms = 0;    // the file, until the soup is in memory
  double plan_ms = 0;    // make_plan or make_baseline_plan, without copies of the data
  double upload_ms = 0;  // buffers, textures and shaders, until the device has finished
  double peak_mib = 0;   // largest resident set of the process, without targets; 0: unknown
  double device_mib = 0;
  double disk_mib = 0;    // of the scene's files; 0: unknown
  double memory_mib = 0;  // of the scene's arrays; 0: unknown
};

struct BenchConfiguration {
  std::string name;                  // "tureen", "generic", "published", "empty fragments", ..
  std::vector<std::string> options;  // equivalent ones of `tureen render`; empty for ceilings
  std::vector<std::string> plan;     // describe()
  double plan_ms = 0;
  double upload_ms = 0;
  double device_mib = 0;
  /// In the plan; empty in files of earlier versions.
  std::vector<AppliedSpecialisation> specialisations = {};
};

/// One configuration with one set of cameras at one size.
struct BenchMeasurement {
  std::string configuration;
  std::string camera_set;  // "hemisphere:8", ..
  std::string size;        // "1280x720", or "full", "half", "quarter" of recorded cameras
  int width = 0;           // of the first view
  int height = 0;
  int views = 0;
  int frames_per_sample = 1;
  int frames = 0;  // timed frames: views * rounds * frames_per_sample
  FrameStatistics frame_ms;
  double fps = 0;        // 1000 / mean
  double aa_spread = 0;  // of the first configuration against itself, with these cameras
  bool stable = true;    // whether the warm-up became stable

  /// (pass, milliseconds by the device's clock) in frame order, mean over the views. If times are
  /// missing or cover only a part of the frame, `passes_gap` has the reason.
  std::vector<std::pair<std::string, double>> passes_ms;
  PassTimesGap passes_gap = PassTimesGap::none;
  std::string passes_reason;
  /// Sum of all passes by the device's clock, for comparison with frame_ms.
  std::optional<double> gpu_ms;

  /// Of splats: the part of a frame in which the processor sorts them (order_ms()).
  std::optional<double> order_ms = {};

  std::vector<double> views_ms;      // the median of each view
  std::string pixels_hash;           // of the last timed frame; 16 hexadecimal digits
  std::optional<std::string> image;  // PNG of that frame, if requested
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
  std::vector<std::string> notes;  // on reading the scene and cameras, and on skipped cases
  /// Largest resident set of the process in MiB after all measurements, including the targets and
  /// all cases. Empty if unknown.
  std::optional<double> peak_mib = {};
};

/// One set of cameras at one size.
struct BenchViews {
  std::string camera_set;  // the name in the result: "hemisphere:8", ..
  std::string size;        // "1280x720", or "full", "half", "quarter" of recorded cameras
  std::vector<Camera> cameras;
};

}  // namespace tureen
