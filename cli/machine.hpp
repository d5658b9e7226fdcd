// The machine that figures are measured on, and what this process takes of it.
#pragma once

#include <string>

namespace tureen::cli {

struct Machine {
  std::string cpu = "unknown";  // the model's name
  int cores = 0;                // that this process may use; 0 where it cannot be told
  double memory_mib = 0;        // 0 where it cannot be told
};

Machine this_machine();

/// The largest resident set of this process so far, in MiB; 0 where it cannot be told.
double peak_mib();

}  // namespace tureen::cli
