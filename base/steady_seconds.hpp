// The clock that measures durations.
#pragma once

#include <chrono>

namespace tureen {

/// Seconds since an arbitrary moment, the same for the whole process.
inline double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace tureen
