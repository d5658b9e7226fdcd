// The machine that figures are measured on, and what this process takes of it.
#pragma once

#include <optional>
#include <string>

namespace tureen {

struct Machine {
  std::string cpu = "unknown";  // the model's name
  int cores = 0;                // that this process may use; 0 where it cannot be told
  double memory_mib = 0;        // 0 where it cannot be told
  std::optional<int> rasteriser_threads = {};  // where llvmpipe draws: rasteriser_threads_of
};

/// But for rasteriser_threads, which depend on the device.
Machine this_machine();

/// How many threads are asked to draw where GL_RENDERER is `renderer` and that is llvmpipe's, as
/// Mesa counts them: LP_NUM_THREADS where that is a number, else one a core, and 0, the thread that
/// calls OpenGL, for a single core. Above it Mesa has a limit of its own.
std::optional<int> rasteriser_threads_of(const std::string& renderer);

/// The largest resident set of this process so far, in MiB; 0 where it cannot be told.
double peak_mib();

}  // namespace tureen
