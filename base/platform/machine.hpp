// The machine of a measurement, and the memory use of this process.
#pragma once

#include <optional>
#include <string>

namespace tureen {

struct Machine {
  std::string cpu = "unknown";                 // the model name
  int cores = 0;                               // available to this process; 0 if unknown
  double memory_mib = 0;                       // 0 if unknown
  std::optional<int> rasteriser_threads = {};  // with llvmpipe: rasteriser_threads_of
};

/// Everything except rasteriser_threads, which depend on the device.
Machine this_machine();

/// The number of threads that llvmpipe is asked to draw with; nullopt if `renderer` (GL_RENDERER)
/// is not llvmpipe. As in Mesa: LP_NUM_THREADS if that is a number, else one per core, or 0 on a
/// single core. 0 means the thread that calls OpenGL. Mesa's own upper limit is not applied.
std::optional<int> rasteriser_threads_of(const std::string& renderer);

/// The largest resident set of this process so far, in MiB; 0 if unknown.
double peak_mib();

}  // namespace tureen
